# SPDX-License-Identifier: GPL-3.0-or-later
flotsam_test(flowAtRest verification SOURCES verification/flowAtRest.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(openTop verification SOURCES verification/openTop.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(inlets verification SOURCES verification/inlets.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(tallCells verification SOURCES verification/tallCells.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(tankAtRest verification SOURCES verification/tankAtRest.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(patchWalls verification SOURCES verification/patchWalls.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(slipEdge verification SOURCES verification/slipEdge.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(slipBend verification SOURCES verification/slipBend.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(liquidShares unit SOURCES unit/liquidShares.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2 3)
flotsam_test(viscousForce unit SOURCES unit/viscousForce.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(eddyViscosity unit SOURCES unit/eddyViscosity.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(liquidPlace unit SOURCES unit/liquidPlace.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(openBoundary unit SOURCES unit/openBoundary.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(shutPockets unit SOURCES unit/shutPockets.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(profileKeeping unit SOURCES unit/profileKeeping.cpp LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(wallLaw unit SOURCES unit/wallLaw.cpp LIBRARIES flotsam_equations flotsam_test_support)
flotsam_test(layerSeparation unit SOURCES unit/layerSeparation.cpp LIBRARIES flotsam_equations)
flotsam_test(bluffBody verification SOURCES verification/bluffBody.cpp
  LIBRARIES flotsam_equations flotsam_test_support)
flotsam_test(facetGroups unit SOURCES unit/facetGroups.cpp LIBRARIES flotsam_equations)
flotsam_test(keptCholesky unit SOURCES unit/keptCholesky.cpp LIBRARIES flotsam_algebra)
flotsam_test(slipNormals unit SOURCES unit/slipNormals.cpp LIBRARIES flotsam_equations)
flotsam_test(nodeInertia unit SOURCES unit/nodeInertia.cpp LIBRARIES flotsam_transport_support)
flotsam_test(elementLanes unit SOURCES unit/elementLanes.cpp LIBRARIES flotsam_transport_support)
target_compile_options(test_elementLanes PRIVATE -Wno-psabi)
flotsam_test(gasDepth verification SOURCES verification/gasDepth.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(gravityWeight verification SOURCES verification/gravityWeight.cpp
  LIBRARIES flotsam_equations flotsam_test_support)
flotsam_test(uniformMotion verification SOURCES verification/uniformMotion.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(fineScale verification SOURCES verification/fineScale.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(fallingSpray verification SOURCES verification/fallingSpray.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(pressureLevel verification SOURCES verification/pressureLevel.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(basins verification SOURCES verification/basins.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(movingGates verification SOURCES verification/movingGates.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(solidEdge verification SOURCES verification/solidEdge.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(squeezedFluid verification SOURCES verification/squeezedFluid.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(velocityChoice unit SOURCES unit/velocityChoice.cpp LIBRARIES flotsam_algebra)
flotsam_test(viscousSolve verification SOURCES verification/viscousSolve.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(iterationCounts verification SOURCES verification/iterationCounts.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(narrowGaps verification SOURCES verification/narrowGaps.cpp
  LIBRARIES flotsam_equations flotsam_test_support)
flotsam_test(boxPile verification SOURCES verification/boxPile.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(allocations verification SOURCES verification/allocations.cpp
  LIBRARIES flotsam_coupling flotsam_test_support)
target_link_options(test_allocations PRIVATE -Wl,--wrap=malloc)
flotsam_test(stepLengths verification SOURCES verification/stepLengths.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(enteringBodies verification SOURCES verification/enteringBodies.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(addedBodies verification SOURCES verification/addedBodies.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(fastBodies verification SOURCES verification/fastBodies.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(heldBody verification SOURCES verification/heldBody.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(struckBody verification SOURCES verification/struckBody.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)
flotsam_test(tetheredBody verification SOURCES verification/tetheredBody.cpp
  LIBRARIES flotsam_coupling flotsam_test_support RANKS 1 2)

add_library(flotsam_flow_support STATIC support/forcedFlow.cpp support/manufactured.cpp support/cutFlows.cpp
  support/systemMatrix.cpp support/budgets.cpp)
target_link_libraries(flotsam_flow_support PUBLIC flotsam_equations flotsam_test_support doctest::doctest)

flotsam_test(manufactured verification SOURCES verification/manufactured.cpp LIBRARIES flotsam_flow_support)
flotsam_test(manufactured3D verification SOURCES verification/manufactured3D.cpp LIBRARIES flotsam_flow_support)
flotsam_test(cutManufactured verification SOURCES verification/cutManufactured.cpp LIBRARIES flotsam_flow_support)
flotsam_test(cutManufactured3D verification SOURCES verification/cutManufactured3D.cpp LIBRARIES flotsam_flow_support)
flotsam_test(cutPositions verification SOURCES verification/cutPositions.cpp LIBRARIES flotsam_flow_support)
flotsam_test(timeOrder verification SOURCES verification/timeOrder.cpp LIBRARIES flotsam_flow_support)
flotsam_test(carriedRemainder verification SOURCES verification/carriedRemainder.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(taylorGreen verification SOURCES verification/taylorGreen.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(cavity verification SOURCES verification/cavity.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(addedMass verification SOURCES verification/addedMass.cpp LIBRARIES flotsam_flow_support)
flotsam_test(neutralBody verification SOURCES verification/neutralBody.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(thinBodies verification SOURCES verification/thinBodies.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(floatingUnions verification SOURCES verification/floatingUnions.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(roundBody verification SOURCES verification/roundBody.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(leavingBodies verification SOURCES verification/leavingBodies.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(touchingBodies verification SOURCES verification/touchingBodies.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(surfacePressure verification SOURCES verification/surfacePressure.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(patchForces verification SOURCES verification/patchForces.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(surfaceTimeOrder verification SOURCES verification/surfaceTimeOrder.cpp LIBRARIES flotsam_flow_support)
flotsam_test(carriedPhase verification SOURCES verification/carriedPhase.cpp LIBRARIES flotsam_flow_support RANKS 1 2)
flotsam_test(actionReaction verification SOURCES verification/actionReaction.cpp
  LIBRARIES flotsam_equations flotsam_test_support RANKS 1 2)
flotsam_test(budgets verification SOURCES verification/budgets.cpp LIBRARIES flotsam_flow_support flotsam_coupling RANKS 1 2)
flotsam_test(flatBody verification SOURCES verification/flatBody.cpp LIBRARIES flotsam_flow_support flotsam_coupling RANKS 1 2)
