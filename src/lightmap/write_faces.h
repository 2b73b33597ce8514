#pragma once

#include <filesystem>

#include "scene/mesh.h"
#include "scene/scene.h"
#include "solver/solution.h"

namespace hemirad {

/// The solution as numbers, CSV: one row an input polygon in file order, numbered from 0, with its
/// area (m^2), centroid (m) and the area means (W/m^2) of what was solved on its front. A face that
/// the mesher dropped keeps its row: number, object and material, the rest empty. The columns of
/// parts of the light are called NAME.irradiance.BAND, names as part_names().
/// 9 significant digits. Throws OutputError.
void write_faces(const std::filesystem::path& path, const Scene& scene, const Mesh& mesh,
                 const Solution& solution);

}  // namespace hemirad
