#pragma once

#include <filesystem>
#include <vector>

#include "view/lit_scene.h"

namespace hemirad {

/// A page to look at the scene in a browser, all in one file, which fetches nothing. Throws
/// OutputError.
void write_page(const std::filesystem::path& path, const LitScene& lit,
                const std::vector<Snapshot>& snapshots);

}  // namespace hemirad
