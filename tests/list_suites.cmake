# Writes LIST, which tells ctest of the suites of PROGRAM; see discover_suites.cmake.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests
    OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
# A suite begins its line and ends in a point; its cases are indented. Parameters and types follow
# after a #.
string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\." suites "${output}")
if(NOT suites)
    message(FATAL_ERROR "${PROGRAM} lists no tests")
endif()

set(text "")
foreach(suite IN LISTS suites)
    string(REGEX REPLACE "[\n.]" "" suite "${suite}")
    set(label ${LABEL})
    set(timeout ${TIMEOUT})
    if(LONG_TIMEOUT AND suite MATCHES "Long")
        set(label long)
        set(timeout ${LONG_TIMEOUT})
    endif()
    set(test ${TARGET}.${suite})
    string(APPEND text
        "add_test([=[${test}]=] [=[${PROGRAM}]=] --gtest_brief=1 [=[--gtest_filter=${suite}.*]=])\n"
        "set_tests_properties([=[${test}]=] PROPERTIES LABELS ${label} TIMEOUT ${timeout} "
        "RESOURCE_LOCK ${TARGET} ENVIRONMENT [=[POCL_CACHE_DIR=${CACHE}]=])\n")
endforeach()
file(WRITE ${LIST} "${text}")
