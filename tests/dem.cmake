# SPDX-License-Identifier: GPL-3.0-or-later
# DEM engine: contact law, walls, states
set(dem_support unit/demSupport.cpp)
flotsam_test(demLaw unit SOURCES unit/demLaw.cpp ${dem_support} LIBRARIES flotsam_liggghts)
flotsam_test(demEngine unit SOURCES unit/demEngine.cpp ${dem_support} LIBRARIES flotsam_liggghts)
flotsam_test(demState unit SOURCES unit/demState.cpp ${dem_support} LIBRARIES flotsam_liggghts RANKS 1 2)
flotsam_test(demWalls unit SOURCES unit/demWalls.cpp ${dem_support} LIBRARIES flotsam_liggghts)
flotsam_test(demMovers unit SOURCES unit/demMovers.cpp ${dem_support} LIBRARIES flotsam_liggghts)
flotsam_test(demMotion verification SOURCES verification/demMotion.cpp ${dem_support} LIBRARIES flotsam_liggghts)
flotsam_test(demContact verification SOURCES verification/demContact.cpp ${dem_support} LIBRARIES flotsam_liggghts)
flotsam_test(motionCheck unit SOURCES unit/motionCheck.cpp LIBRARIES flotsam_coupling)
flotsam_test(smoothMotion unit SOURCES unit/smoothMotion.cpp LIBRARIES flotsam_coupling)
flotsam_test(entryCheck unit SOURCES unit/entryCheck.cpp LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(meshExit unit SOURCES unit/meshExit.cpp LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
