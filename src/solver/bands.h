#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/mesh.h"

namespace hemirad {

/// Which bands have to be solved. Bands of equal reflectance whose emission is proportional share
/// one solution: a grey scene is solved once, whatever its file names.
struct BandPlan {
    std::vector<std::size_t> solved;    ///< scene bands, one for each solution
    std::vector<std::size_t> solution;  ///< [scene band] index into `solved`
};

/// Throws InputError where there is uncountable_light().
BandPlan plan_bands(const Mesh& mesh);

/// What is wrong with a band that emits more or less than numbers of the ledger can hold.
std::optional<std::string> uncountable_light(const Mesh& mesh);

/// Flux that a band's patches emit on their own, W.
double emitted_flux(const Mesh& mesh, std::size_t band);

/// Of any band.
bool emits_light(const Mesh& mesh);

/// Own emission of a patch as radiosity, pi * radiance, W/m^2.
double emitted_radiosity(const Mesh& mesh, const Patch& patch, std::size_t band);

/// Reflectance of a patch as the device holds it.
float reflectance(const Mesh& mesh, const Patch& patch, std::size_t band);

}  // namespace hemirad
