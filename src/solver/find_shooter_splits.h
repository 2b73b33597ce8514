#pragma once

#include <vector>

#include "scene/mesh.h"
#include "solver/solution.h"

namespace hemirad {

/// Which shooters split_mesh() should split: those that make what stands near them wrong, because
/// they shoot the mean radiosity of elements that differ. The error of irradiance at a receiver's
/// centre is the sum, over the shooter's elements, of what each differs from the mean times the
/// unblocked factor to it. Where, in any band, its square over the receivers' area comes to more
/// than that of `bound` of the mean irradiance over an area as large as the shooter was unsplit,
/// the error is worth a split; as find_splits() says of elements, so that either is split where
/// that takes as much of the mean square away. By shooter; none for patches that shoot alone.
std::vector<bool> find_shooter_splits(const Mesh& mesh, const Solution& solution, double bound);

}  // namespace hemirad
