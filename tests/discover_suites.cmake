# hemirad_discover_suites(TARGET LABEL LABEL TIMEOUT SECONDS [LONG_TIMEOUT SECONDS]): a ctest a suite
# of GoogleTest, TARGET.SUITE, found when TARGET is built. A process each case, as gtest_discover_tests has it,
# spends half a second on opening the OpenCL device and loading the compiler each time. Suites take
# turns within a TARGET: many need the same kernels, which the first leaves in PoCL's cache, and
# which two at a time would both compile. With LONG_TIMEOUT those named *Long* get the label long.
function(hemirad_discover_suites target)
    cmake_parse_arguments(arg "" "LABEL;TIMEOUT;LONG_TIMEOUT" "" ${ARGN})
    set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
    add_custom_command(TARGET ${target} POST_BUILD BYPRODUCTS ${list}
        COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${target}> -DLIST=${list} -DTARGET=${target}
            -DLABEL=${arg_LABEL} -DTIMEOUT=${arg_TIMEOUT} -DLONG_TIMEOUT=${arg_LONG_TIMEOUT}
            -DCACHE=${CMAKE_BINARY_DIR}/pocl-cache -P ${PROJECT_SOURCE_DIR}/tests/list_suites.cmake
        VERBATIM)
    set(include ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake)
    file(CONFIGURE OUTPUT ${include} @ONLY CONTENT [[
if(EXISTS "@list@")
    include("@list@")
else()
    add_test(@target@_NOT_BUILT @target@_NOT_BUILT)
endif()
]])
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${include})
endfunction()
