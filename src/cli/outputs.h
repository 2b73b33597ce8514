#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/gather_lightmaps.h"
#include "cli/solve_options.h"
#include "lightmap/chart_layout.h"
#include "scene/camera.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "solver/solution.h"

namespace hemirad {

/// Every file that the options ask for, in the order of writing; the report comes last.
std::vector<std::filesystem::path> output_files(const SolveOptions& options);

/// Viewers go by a file's ending, and no part of a scene but a glTF has one of ours: InputError
/// where it is another. Devices and pipes have none.
void check_ending(std::string_view option, const std::filesystem::path& file,
                  std::initializer_list<std::string_view> endings);

/// InputError where two of the files are one, or one is the scene.
void check_distinct(const std::filesystem::path& scene,
                    const std::vector<std::filesystem::path>& files);

/// InputError where one of the files is one that belongs to the scene: what it was read from, or a
/// picture it names.
void keep_side_files(const Scene& scene, const std::vector<std::filesystem::path>& files);
/// The same of all that the options ask for, and of the kept snapshots that are there already.
void check_side_files(const SolveOptions& options, const Scene& scene);

/// Before the work begins: throws InputError where two outputs are one file, or one is the scene,
/// or a name ends unfittingly; OutputError where one could not be written.
void check_outputs(const SolveOptions& options);

/// Lightmaps, with their layers, and previews of the solution so far; `error`, if not null, is a
/// layer, and what was `gathered` is shown instead of what patches tell. How many texels of each
/// atlas surfaces reach into.
std::vector<std::size_t> write_picture(const SolveOptions& options, const Mesh& mesh,
                                       const ChartLayout& layout, const Solution& solution,
                                       const Solution* error = nullptr,
                                       const GatheredLightmaps* gathered = nullptr);

/// As write_picture() and write_solved_scene(), with_ambient(); the lightmap's header says so. Says
/// why one could not be written, which ends no solve: the final picture is what counts.
std::optional<std::string> write_interim_picture(const SolveOptions& options, const Scene& scene,
                                                 const std::vector<Camera>& cameras,
                                                 const Mesh& mesh, const ChartLayout& layout,
                                                 const Solution& solution);

/// The scene with its irradiance and the cameras, if the options ask for it.
void write_solved_scene(const SolveOptions& options, const Scene& scene,
                        const std::vector<Camera>& cameras, const Mesh& mesh,
                        const ChartLayout& layout, const Solution& solution,
                        const GatheredLightmaps* gathered = nullptr);

/// A warning for each band whose light is so weak that the lightmap's pixels lose digits of all of
/// it.
std::vector<std::string> faint_bands(const SolveOptions& options, const Solution& solution);

}  // namespace hemirad
