# Writes to OUTPUT one test of ctest for each suite of the Google Test program PROGRAM without
# the tests that LEAVES_OUT matches: the start of a process takes longer than a short test.
set(but "")
if(NOT "${LEAVES_OUT}" STREQUAL "")
  set(but "-${LEAVES_OUT}")
endif()
execute_process(COMMAND ${PROGRAM} --gtest_list_tests --gtest_filter=*${but}
                OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE ";" "\\;" list "${list}")
string(REPLACE "\n" ";" lines "${list}")
set(text "")
foreach(line IN LISTS lines)
  # "Suite.", or "Suite/0.  # TypeParam = float"; its tests are indented.
  if(line MATCHES "^([^ ]+)\\.( |$)")
    set(suite ${CMAKE_MATCH_1})
    string(APPEND text
      "add_test([=[${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*${but}]=])\n"
      "set_tests_properties([=[${suite}]=] PROPERTIES LABELS ${LABEL}\n"
      "  ENVIRONMENT [=[${ENVIRONMENT}]=] ENVIRONMENT_MODIFICATION [=[${MODIFICATION}]=])\n")
  endif()
endforeach()
if(text STREQUAL "")
  message(FATAL_ERROR "${PROGRAM} has no suites: ${list}")
endif()
file(WRITE ${OUTPUT} "${text}")
