# SPDX-License-Identifier: GPL-3.0-or-later
flotsam_test(checkpoint unit SOURCES unit/checkpoint.cpp LIBRARIES flotsam_io RANKS 1 2)
flotsam_test(fluidRecord unit SOURCES unit/fluidRecord.cpp LIBRARIES flotsam_io RANKS 1)
flotsam_test(bodyHistory unit SOURCES unit/bodyHistory.cpp LIBRARIES flotsam_io RANKS 1)
flotsam_test(contactSeries unit SOURCES unit/contactSeries.cpp LIBRARIES flotsam_io RANKS 1)
flotsam_test(runLog unit SOURCES unit/runLog.cpp LIBRARIES flotsam_io RANKS 1)
flotsam_test(stopSignal unit SOURCES unit/stopSignal.cpp LIBRARIES flotsam_io RANKS 1)

# what the tutorials evaluate results with; needs the system's Python with VTK and h5py
find_program(FLOTSAM_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
execute_process(COMMAND ${FLOTSAM_PYTHON} -c "import h5py, vtkmodules.vtkIOGeometry" RESULT_VARIABLE missing OUTPUT_QUIET ERROR_QUIET)
if(missing STREQUAL "0")
  add_executable(writeHistoryExample support/writeHistoryExample.cpp)
  target_link_libraries(writeHistoryExample PRIVATE flotsam_io)
  add_test(NAME unit.postProcessing
    COMMAND ${FLOTSAM_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/support/postProcessing.py $<TARGET_FILE:writeHistoryExample>)
  set_tests_properties(unit.postProcessing PROPERTIES LABELS unit ENVIRONMENT "${FLOTSAM_TEST_ENVIRONMENT}" TIMEOUT 600)
  add_test(NAME unit.clogging COMMAND ${FLOTSAM_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/support/clogging.py)
  set_tests_properties(unit.clogging PROPERTIES LABELS unit TIMEOUT 60)
  add_test(NAME unit.jamShape COMMAND ${FLOTSAM_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/support/jamShape.py)
  set_tests_properties(unit.jamShape PROPERTIES LABELS unit TIMEOUT 60)
else()
  message(STATUS "unit.postProcessing, unit.clogging, unit.jamShape left out: ${FLOTSAM_PYTHON} lacks h5py or VTK (packages python3-h5py, python3-vtk9)")
endif()
