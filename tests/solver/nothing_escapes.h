#pragma once

#include <gtest/gtest.h>

#include "solver/support.h"

/// Looks from the patches of a closed scene for a way out.
namespace hemirad::test {

/// Whether a patch touches the front of another with its own, as the bottom of a crate does the
/// floor's: nothing sees it, and it sees nothing.
inline bool is_pressed_shut(const Mesh& mesh, const Patch& patch) {
    const auto centre = mesh.centroid(patch), normal = mesh.normal(patch);
    for (const auto& other : mesh.patches) {
        const auto& corner = mesh.vertices[other.corners[0]];
        if (std::abs(glm::dot(normal, corner - centre)) > 1e-9) continue;
        if (glm::dot(normal, mesh.normal(other)) > 0) continue;
        bool inside = true;
        for (int k = 0; k < 4; ++k) {
            const auto &a = mesh.vertices[other.corners[k]],
                       &b = mesh.vertices[other.corners[(k + 1) % 4]];
            inside = inside && glm::dot(glm::cross(b - a, centre - a), normal) <= 1e-9;
        }
        if (inside) return true;
    }
    return false;
}

/// Shoots from every `step`-th patch, from a part of it that changes from one to the next.
inline void expect_nothing_escapes(const Mesh& mesh, std::uint32_t resolution,
                                   std::uint32_t step = 1) {
    EXPECT_TRUE(mesh.closed);
    Shooters shooters(mesh, resolution, 3);
    std::uint64_t proxels = 0, shots = 0;
    for (std::uint32_t patch = 0; patch < shooters.patch_count(); patch += step) {
        if (is_pressed_shut(mesh, mesh.patches[patch])) continue;
        const std::uint32_t part = static_cast<std::uint32_t>(shots % shooters.part_count());
        const auto count = shooters.count(patch, part);
        EXPECT_EQ(count.owned + count.escaped, shooters.proxels_a_part());
        EXPECT_EQ(count.escaped, 0u)
            << "shooter " << patch << ", part " << part << ", resolution " << resolution;
        proxels += count.owned + count.escaped;
        ++shots;
    }
    EXPECT_GT(proxels, 0u);
}

}  // namespace hemirad::test
