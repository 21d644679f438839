# SPDX-License-Identifier: GPL-3.0-or-later
flotsam_test(flowAtRest verification SOURCES verification/flowAtRest.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(tankAtRest verification SOURCES verification/tankAtRest.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(heldBody verification SOURCES verification/heldBody.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
