# The program, and the library as hemirad::hemirad for find_package(hemirad).
# Headers include one another as in src/, so include/hemirad is what consumers have in their path.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(headers ${CMAKE_INSTALL_INCLUDEDIR}/hemirad)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/hemirad)

add_library(hemirad_library INTERFACE)
add_library(hemirad::hemirad ALIAS hemirad_library)
set_target_properties(hemirad_library PROPERTIES EXPORT_NAME hemirad)
target_compile_features(hemirad_library INTERFACE cxx_std_20)
target_link_libraries(hemirad_library INTERFACE hemirad_solver hemirad_lightmap hemirad_scene)
target_include_directories(hemirad_library INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${headers}>)

install(TARGETS hemirad RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# What `hemirad sweep` takes unless told otherwise.
install(FILES scenes/hall2k.obj scenes/hall2k.mtl scenes/hall14k.obj scenes/hall14k.mtl
    DESTINATION ${CMAKE_INSTALL_DATADIR}/hemirad/scenes)
install(TARGETS hemirad_library hemirad_solver hemirad_formfactor hemirad_lightmap hemirad_scene mp1map
    hemirad_flags
    EXPORT hemirad-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT hemirad-targets NAMESPACE hemirad:: DESTINATION ${package})

# What read_scene, build_mesh, ProgressiveSolver and the writers of lightmaps need, not their insides.
set(public_headers
    errors.h
    scene/lights.h scene/mesh.h scene/read_scene.h scene/scene.h
    formfactor/form_factors.h
    solver/bands.h solver/forecast.h solver/near_pairs.h solver/patch_arrays.h
    solver/shot_pipeline.h solver/solution.h solver/solve_state.h solver/solver.h
    solver/view_factors.h
    lightmap/atomic_file.h lightmap/chart_layout.h lightmap/lightmap.h
    lightmap/lightmap_uvs.h lightmap/rasterize.h
    lightmap/write_exr.h lightmap/write_faces.h lightmap/write_preview.h)
foreach(header IN LISTS public_headers)
    cmake_path(GET header PARENT_PATH folder)
    install(FILES src/${header} DESTINATION ${headers}/${folder})
endforeach()
install(DIRECTORY mp1map DESTINATION ${headers} FILES_MATCHING PATTERN *.h)
install(FILES kernels/shared.h DESTINATION ${headers}/kernels)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/hemirad-config.cmake.in
    ${PROJECT_BINARY_DIR}/hemirad-config.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/hemirad-config-version.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/hemirad-config.cmake
    ${PROJECT_BINARY_DIR}/hemirad-config-version.cmake DESTINATION ${package})
