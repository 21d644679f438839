# SPDX-License-Identifier: GPL-3.0-or-later
add_library(flotsam_transport_support STATIC support/transportScene.cpp)
target_link_libraries(flotsam_transport_support PUBLIC flotsam_equations flotsam_test_support)

flotsam_test(dualCells unit SOURCES unit/dualCells.cpp LIBRARIES flotsam_equations flotsam_test_support)
flotsam_test(filmFit unit SOURCES unit/filmFit.cpp LIBRARIES flotsam_equations flotsam_test_support)
flotsam_test(frontFit unit SOURCES unit/frontFit.cpp LIBRARIES flotsam_equations flotsam_test_support)
flotsam_test(profileMeans unit SOURCES unit/profileMeans.cpp LIBRARIES flotsam_equations)
flotsam_test(startProfile unit SOURCES unit/startProfile.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2 3)
flotsam_test(zalesak verification SOURCES verification/zalesak.cpp LIBRARIES flotsam_transport_support)
flotsam_test(vortex verification SOURCES verification/vortex.cpp LIBRARIES flotsam_transport_support)
flotsam_test(deformation3D verification SOURCES verification/deformation3D.cpp LIBRARIES flotsam_transport_support)

add_executable(transportTable ${PROJECT_SOURCE_DIR}/benchmarks/transport/transportTable.cpp)
target_link_libraries(transportTable PRIVATE flotsam_transport_support)
flotsam_test(volumeFlux unit SOURCES unit/volumeFlux.cpp LIBRARIES flotsam_transport_support)
flotsam_test(dualCellTransport unit SOURCES unit/dualCellTransport.cpp LIBRARIES flotsam_transport_support RANKS 1 2 3)
flotsam_test(transportSolids verification SOURCES verification/transportSolids.cpp LIBRARIES flotsam_transport_support RANKS 1 2)
flotsam_test(phaseFieldSupg verification SOURCES verification/phaseFieldSupg.cpp LIBRARIES flotsam_transport_support RANKS 1 2)
