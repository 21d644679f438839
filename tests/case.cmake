# SPDX-License-Identifier: GPL-3.0-or-later
# Whole cases: the first steps of every tutorial, restart, processes, signals, messages. Scripts in case/.
function(flotsam_case name script)
  add_test(NAME case.${name} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/case/${script} ${ARGN})
  set_tests_properties(case.${name} PROPERTIES LABELS case TIMEOUT 600
    ENVIRONMENT "FLOTSAM_BUILD=${CMAKE_BINARY_DIR};${FLOTSAM_TEST_ENVIRONMENT}")
endfunction()

flotsam_case(messages messages.sh)
flotsam_case(dryRun dryRun.sh)
flotsam_case(restart restart.sh)
flotsam_case(restartRanks restartRanks.sh)
flotsam_case(bodiesLeave bodiesLeave.sh)
flotsam_case(stop stop.sh)
flotsam_case(parallel2D parallel.sh 2D)
flotsam_case(parallel3D parallel.sh 3D)
flotsam_case(parallelBars parallelBars.sh)
flotsam_case(cellCost cellCost.sh)
flotsam_case(stretchedRest stretchedRest.sh)
flotsam_case(refinedRest refinedRest.sh)
set_tests_properties(case.parallel2D case.parallel3D case.parallelBars case.cellCost case.dryRun case.restartRanks case.bodiesLeave case.stretchedRest case.refinedRest PROPERTIES PROCESSORS 2)
foreach(tutorial damBreak flowPastCylinder fallingSphere floatingBar barAgainstPost slitDam bridgePier debrisRack)
  flotsam_case(${tutorial} tutorial.sh ${tutorial})
endforeach()
