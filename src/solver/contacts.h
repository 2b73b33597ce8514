#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"
#include "solver/patch_shapes.h"

namespace hemirad {

/// Fronts of two patches that lie on each other, as a crate's bottom does on a floor: where they do
/// they see each other and nothing else.
struct Contact {
    std::uint32_t first, second;
    double area;  ///< of what touches
};

/// Of patches of different objects; the two sides of a sheet are of one, and no contact.
std::vector<Contact> contacts(const Mesh& mesh, const std::vector<PatchShape>& patches);

}  // namespace hemirad
