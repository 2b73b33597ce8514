#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"

/// Where a hemisphere at a shooter's centre is not enough. What a point sees of a patch differs
/// from the mean over the shooter by the second order of shooter's size over distance: relative to
/// the factor about 0.1 (radius / distance)^2. (Perpendicular squares that touch: 5 % of what the
/// receiver gets; directly opposed ones at their size: 20 %.)
namespace hemirad {

/// Closed forms from polygon to polygon, by shooter.
struct NearPairs {
    std::vector<std::int32_t> begin;  ///< [shooter], and one more: into the other two
    std::vector<std::int32_t> patch;  ///< that faces the shooter
    std::vector<float> form_factor;   ///< from the shooter, unblocked
};

/// Pairs for which one hemisphere at the centre may be wrong by more than `error`, of the factor
/// from receiver to shooter: that is what a receiver's irradiance goes by.
NearPairs near_pairs(const Mesh& mesh, double error);

/// How often a shooter finds a patch near, from one in so many shooters that a thousand look, or
/// fewer where each has many to look at.
std::uint64_t estimated_near_finds(const Mesh& mesh, double error);

/// What near_pairs() takes while it makes them, for so many finds.
std::uint64_t near_pairs_bytes(const Mesh& mesh, std::uint64_t finds);

/// M of the M x M hemispheres that each shooter needs to keep that error below `error`, 1 to
/// `most`.
std::vector<std::int32_t> shooter_samples_for(const Mesh& mesh, double error, std::int32_t most);

}  // namespace hemirad
