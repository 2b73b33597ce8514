#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "solver/support.h"

// Progressive refinement and the full matrix (sec. 1.2) solve the same equation.
namespace hemirad::test::full_matrix_test {
namespace {

constexpr std::uint32_t kResolution = 256;

// Of the patch's own value or, where next to no light comes (the floor under a block), of a
// hundredth of the mean: what is left unshot is a part of all light, not of a patch's.
double largest_difference_of_lit(const std::vector<double>& a, const std::vector<double>& b) {
    const double least =
        0.01 * std::accumulate(b.begin(), b.end(), 0.0) / static_cast<double>(b.size());
    double largest = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
        largest = std::max(largest, std::abs(a[i] - b[i]) / std::max(std::abs(b[i]), least));
    return largest;
}

void expect_full_matrix_solution(const Mesh& mesh, std::uint32_t samples) {
    ASSERT_LE(mesh.patches.size(), 500u);
    const auto matrix = Shooters(mesh, kResolution, samples).form_factor_matrix();

    auto how = settings(kResolution, 1e-6);
    how.shooter_samples = samples;
    const auto solution = solution_of(mesh, how);

    double largest = 0;
    for (std::size_t band = 0; band < mesh.bands.size(); ++band) {
        const auto full = full_matrix_solution(mesh, matrix, band);
        ASSERT_TRUE(full.converged);
        largest =
            std::max(largest, largest_difference_of_lit(solution.radiosity[band], full.radiosity));
        largest = std::max(largest,
                           largest_difference_of_lit(solution.irradiance[band], full.irradiance));
        const auto& ledger = solution.ledger[band];
        EXPECT_NEAR(ledger.absorbed / full.balance.absorbed, 1, 2e-6);
        EXPECT_NEAR(ledger.escaped / ledger.emitted, full.balance.escaped / full.balance.emitted,
                    2e-6);
    }
    EXPECT_LT(largest, 2e-5);
    testing::Test::RecordProperty("largest_difference", std::to_string(largest));
}

TEST(FullMatrix, AgreesInAClosedFurnishedRoom) {
    expect_full_matrix_solution(meshed(furnished_room(), 0.75), 1);
}

TEST(FullMatrix, AgreesInTheOpenCornellBox) {
    expect_full_matrix_solution(meshed(scene_named("cornell.gltf"), 0.11), 1);
}

TEST(FullMatrix, AgreesWithSeveralHemispheresAShooter) {
    expect_full_matrix_solution(meshed(scene_named("cornell.gltf"), 0.2), 3);
}

TEST(FullMatrix, OfTheScalarReferenceGivesTheSameRadiosity) {
    constexpr std::uint32_t kCoarse = 64;
    const Mesh mesh = meshed(furnished_room(), 1.3);
    Shooters shooters(mesh, kCoarse);
    std::vector<Polygon> polygons;
    std::vector<std::vector<reference::Shooter>> frames;
    for (std::uint32_t i = 0; i < shooters.patch_count(); ++i) {
        Polygon polygon;
        for (int k = 0; k < 4; ++k) polygon.corners[k] = mesh.vertices[mesh.patches[i].corners[k]];
        polygons.push_back(polygon);
        frames.push_back({shooters.frame(i, 0)});
    }
    polygons = normalised(polygons, shooters.arrays());

    const auto scalar = reference::form_factor_matrix(polygons, frames, kCoarse);
    const auto solution = solution_of(mesh, settings(kCoarse, 1e-6));

    // Owners differ where rounding decides only, which is rare where no edge runs through the
    // centres of proxels.
    double largest = 0;
    for (std::size_t band = 0; band < mesh.bands.size(); ++band)
        largest = std::max(largest,
                           largest_difference(solution.radiosity[band],
                                              full_matrix_solution(mesh, scalar, band).radiosity));
    EXPECT_LT(largest, 1e-3);
}

}  // namespace
}  // namespace hemirad::test::full_matrix_test
