#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "scene/gltf_file.h"

namespace hemirad {

/// A node in the world: transforms only ever multiply on the way down.
struct PlacedNode {
    std::size_t node;
    glm::dmat4 world_from_node;
    double quantum = 0;  ///< m, of its place
};

/// The nodes of the scene to read, parents before their children. Throws InputError where they form
/// no trees.
std::vector<PlacedNode> place_nodes(const GltfFile& gltf);

}  // namespace hemirad
