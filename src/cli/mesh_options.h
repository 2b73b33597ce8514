#pragma once

#include "cli/options.h"
#include "scene/mesh.h"

namespace hemirad {

/// --patch-size, --backfaces, --weld and --max-reflectance.
void add_mesh_options(CLI::App& command, MeshSettings& settings);

/// --element-size, of those that solve.
void add_element_size(CLI::App& command, MeshSettings& settings);

/// --split, of solve.
void add_split(CLI::App& command, MeshSettings& settings);

/// The word that --backfaces takes.
std::string name_of(Backfaces backfaces);

}  // namespace hemirad
