# SPDX-License-Identifier: GPL-3.0-or-later
flotsam_test(checkpoint unit SOURCES unit/checkpoint.cpp LIBRARIES flotsam_io RANKS 1 2)
flotsam_test(bodyHistory unit SOURCES unit/bodyHistory.cpp LIBRARIES flotsam_io RANKS 1)
flotsam_test(runLog unit SOURCES unit/runLog.cpp LIBRARIES flotsam_io RANKS 1)
flotsam_test(stopSignal unit SOURCES unit/stopSignal.cpp LIBRARIES flotsam_io RANKS 1)
