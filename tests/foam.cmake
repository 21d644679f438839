# SPDX-License-Identifier: GPL-3.0-or-later
add_library(flotsam_foam_test STATIC support/foamCase.C)
target_link_libraries(flotsam_foam_test PUBLIC flotsam_foam)
target_include_directories(flotsam_foam_test PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_definitions(flotsam_foam_test PRIVATE FLOTSAM_TEST_CASES="${CMAKE_CURRENT_SOURCE_DIR}/cases")

flotsam_test(foamControls unit SOURCES unit/foamControls.C LIBRARIES flotsam_foam_test)
flotsam_test(foamVectoriser unit SOURCES unit/foamVectoriser.C LIBRARIES flotsam_foam_test)
flotsam_test(foamBoundary unit SOURCES unit/foamBoundary.C LIBRARIES flotsam_foam_test RANKS 1 2)
flotsam_test(foamFields unit SOURCES unit/foamFields.C LIBRARIES flotsam_foam_test RANKS 1 2)
flotsam_test(foamWriteTimes unit SOURCES unit/foamWriteTimes.C LIBRARIES flotsam_foam_test)
flotsam_test(foamBodies unit SOURCES unit/foamBodies.C LIBRARIES flotsam_foam_test flotsam_dem_foam RANKS 1 2)
flotsam_test(foamBodiesMessages unit SOURCES unit/foamBodiesMessages.C LIBRARIES flotsam_foam_test flotsam_dem_foam RANKS 1 2)
flotsam_test(foamCaseCheck unit SOURCES unit/foamCaseCheck.C LIBRARIES flotsam_foam_test)
