# Whole solves. Label extremes: seconds, with all other tests; long: a minute or so; soak: more.
set(solves_libs hemirad_solver hemirad_reference hemirad_lightmap)

hemirad_test(extreme_solves_test LABEL extremes LIBS ${solves_libs} SOURCES
    solves_ledger_test.cpp solves_light_test.cpp solves_scale_test.cpp)
hemirad_test(extreme_solves_soak_test LABEL soak LIBS ${solves_libs} SOURCES
    solves_soak_test.cpp)

foreach(target extreme_solves_test extreme_solves_soak_test)
    target_compile_definitions(${target} PRIVATE HEMI_SCENES="${PROJECT_SOURCE_DIR}/scenes")
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
endforeach()
