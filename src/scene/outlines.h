#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace hemirad::meshing {

/// The welded corners of every input face, without repeated ones and without spikes. Empty where
/// fewer than three are left.
struct Outlines {
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> first;  ///< of each face, and the end

    std::span<const std::uint32_t> operator[](std::uint32_t face) const {
        return {corners.data() + first[face], corners.data() + first[face + 1]};
    }
    std::uint32_t face_count() const { return static_cast<std::uint32_t>(first.size() - 1); }
};

Outlines outline_faces(const std::vector<Face>& faces,
                       const std::vector<std::uint32_t>& vertex_of_position);

/// Whether another face has the same corners.
enum class Twin : std::uint8_t {
    none,
    repeats,   ///< an earlier face, in the same order: a duplicate
    reversed,  ///< another face, in opposite order: the two are the sides of one sheet
};

std::vector<Twin> find_twins(const Outlines& outlines);

}  // namespace hemirad::meshing
