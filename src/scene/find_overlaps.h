#pragma once

#include <string>
#include <vector>

#include "scene/mesh.h"
#include "scene/precision.h"

namespace hemirad::meshing {

/// Two fronts that cover the same place: to light they are one on top of the other.
struct Overlap {
    std::uint32_t lower, higher;  ///< surfaces
    double area = 0;              ///< m^2, that they have in common
    glm::dvec3 at{};              ///< a place of it
};

struct Overlaps {
    std::vector<Overlap> pairs;  ///< ordered
    bool complete = true;        ///< false where there were too many pairs to look at
};

/// Fronts of one Surface::plane that face the same way and share more than a strip as wide as
/// Precision::plane.
Overlaps find_overlaps(const Mesh& mesh, const Precision& precision);

/// A line each for the first few, and one for the rest.
std::vector<std::string> warnings_of(const Overlaps& overlaps, const std::string& file,
                                     const Mesh& mesh);

}  // namespace hemirad::meshing
