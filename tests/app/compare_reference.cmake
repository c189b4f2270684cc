# Fails unless the parameter reference that PROGRAM writes to WRITTEN is the one at COMMITTED.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${PROGRAM} reference OUTPUT_FILE ${WRITTEN} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${WRITTEN} ${COMMITTED} RESULT_VARIABLE differs)
if(differs)
  message(FATAL_ERROR "docs/parameters.md is out of date; write it again with: glocal reference > docs/parameters.md")
endif()
