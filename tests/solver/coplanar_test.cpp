#include <gtest/gtest.h>

#include "solver/support.h"

// Patches of one plane see each other edge-on, so they exchange nothing. A row sum does not show
// it where they do: what a patch takes from its own wall it misses elsewhere.
namespace hemirad::test::coplanar_test {
namespace {

bool in_one_plane(const Mesh& mesh, const Patch& a, const Patch& b) {
    const auto normal = mesh.normal(a);
    if (std::abs(glm::dot(normal, mesh.normal(b))) < 1 - 1e-9) return false;
    for (const auto corner : b.corners)
        if (std::abs(glm::dot(normal, mesh.vertices[corner] - mesh.centroid(a))) > 1e-7)
            return false;
    return true;
}

void expect_nothing_between_coplanar_patches(const Mesh& mesh, std::uint32_t resolution) {
    Shooters shooters(mesh, resolution, 2);
    std::uint64_t pairs = 0;
    for (std::uint32_t from = 0; from < shooters.patch_count(); ++from) {
        const auto counts = shooters.proxel_counts(from);
        for (std::uint32_t to = 0; to < shooters.patch_count(); ++to) {
            if (!in_one_plane(mesh, mesh.patches[from], mesh.patches[to])) continue;
            ++pairs;
            EXPECT_EQ(counts[to], 0) << "from " << from << " to " << to;
        }
    }
    EXPECT_GT(pairs, mesh.patches.size());
}

TEST(CoplanarPatches, ReceiveNothingFromEachOtherAlongTheAxes) {
    expect_nothing_between_coplanar_patches(meshed(furnished_room(), 0.5), 128);
}

TEST(CoplanarPatches, ReceiveNothingFromEachOtherInRotatedRooms) {
    std::mt19937 random(3);
    for (int round = 0; round < 8; ++round)
        expect_nothing_between_coplanar_patches(
            meshed(rotated(furnished_room(), random_rotation(random)), 0.8), 128);
}

TEST(CoplanarPatches, ReceiveNothingFromTheBacksOfTheirSheets) {
    std::mt19937 random(4);
    for (int round = 0; round < 3; ++round)
        expect_nothing_between_coplanar_patches(
            meshed(rotated(furnished_room(), random_rotation(random)), 1.2, Backfaces::block), 128);
}

}  // namespace
}  // namespace hemirad::test::coplanar_test
