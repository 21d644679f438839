# SPDX-License-Identifier: GPL-3.0-or-later
add_library(flotsam_test_support STATIC support/boxMesh.cpp support/meshChecks.cpp)
target_link_libraries(flotsam_test_support PUBLIC flotsam_core flotsam_algebra MPI::MPI_CXX)
target_include_directories(flotsam_test_support PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})

flotsam_test(meshGeometry unit SOURCES unit/meshGeometry.cpp LIBRARIES flotsam_test_support)
flotsam_test(meshHalo parallel SOURCES parallel/meshHalo.cpp LIBRARIES flotsam_test_support RANKS 1 2 4)
flotsam_test(meshDistribution parallel SOURCES parallel/meshDistribution.cpp LIBRARIES flotsam_test_support RANKS 1 2 4)

set(meshCases ${CMAKE_CURRENT_BINARY_DIR}/meshCases)
flotsam_test(meshAdapter parallel SOURCES parallel/meshAdapter.C LIBRARIES flotsam_test_support flotsam_foam RANKS 1 2 4)
target_compile_definitions(test_meshAdapter PRIVATE FLOTSAM_MESH_CASES="${meshCases}")
add_test(NAME parallel.meshCases COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/support/makeMeshCases.sh ${meshCases})
set_tests_properties(parallel.meshCases PROPERTIES LABELS parallel FIXTURES_SETUP meshCases ENVIRONMENT "${FLOTSAM_TEST_ENVIRONMENT}")
set_tests_properties(parallel.meshAdapter parallel.meshAdapter.np2 parallel.meshAdapter.np4 PROPERTIES FIXTURES_REQUIRED meshCases)
flotsam_test(nextTimeStep unit SOURCES unit/nextTimeStep.cpp LIBRARIES flotsam_core)
