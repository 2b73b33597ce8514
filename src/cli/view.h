#pragma once

#include <filesystem>
#include <optional>

#include "cli/options.h"

namespace hemirad {

/// hemirad view SOLVED.glb: a page to look at it.
void add_view(CLI::App& app, Command& chosen);

/// SOLVED and --lightmap, of all that read a solved scene.
void add_lit_scene(CLI::App& command, std::filesystem::path& scene,
                   std::optional<std::filesystem::path>& lightmap);

}  // namespace hemirad
