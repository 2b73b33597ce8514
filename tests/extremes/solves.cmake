# Whole solves. Label extremes: seconds, with all other tests; long: half a minute; soak: minutes.
function(extreme_solves_test name label)
    hemirad_test(${name} LABEL ${label} LIBS hemirad_solver hemirad_reference hemirad_lightmap
        SOURCES ${ARGN})
    target_compile_definitions(${name} PRIVATE HEMI_SCENES="${PROJECT_SOURCE_DIR}/scenes")
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
endfunction()

extreme_solves_test(extreme_solves_test extremes
    solves_ledger_test.cpp solves_light_test.cpp solves_plane_test.cpp solves_scale_test.cpp)
extreme_solves_test(extreme_solves_long_test long solves_long_test.cpp)
extreme_solves_test(extreme_solves_soak_test soak solves_soak_test.cpp)

foreach(group Checker Sizes Emissions Lamps Faces Options)
    hemirad_cli_test(Extremes.Cli.${group} solves_test.py GROUP ${group} LABEL extremes)
endforeach()
