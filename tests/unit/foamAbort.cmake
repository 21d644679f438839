# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DCOMMAND="program;with;arguments" -DMESSAGE=REGEX -DPLACE=REGEX -P foamAbort.cmake: it must end with the code 1 and its message, said once, and its place.
execute_process(COMMAND ${COMMAND} RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
string(REGEX MATCHALL "${MESSAGE}" messages "${said}")
list(LENGTH messages n)
if(NOT code STREQUAL "1" OR NOT n EQUAL 1 OR said MATCHES "printStack|sigAbrt|core dumped" OR NOT said MATCHES "${PLACE}")
  message(FATAL_ERROR "exit code ${code}, the message ${n} times:\n${said}")
endif()
