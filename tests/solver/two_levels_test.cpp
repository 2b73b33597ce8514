#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "solver/support.h"

// Patches shoot, their elements receive (Cohen et al.): Mesh::shooters and Mesh::patches.
namespace hemirad::test::two_levels_test {
namespace {

Mesh two_levels(const Scene& scene, double patch_size, double element_size) {
    return build_mesh(
        scene, {.patch_size = patch_size, .element_size = element_size, .max_reflectance = 0.995});
}

// The furnace, B = E / (1 - rho): walls of one patch see the same from everywhere if they are
// sampled well, so every element gets as much.
TEST(TwoLevels, EveryElementOfAFurnaceIsEquallyBright) {
    const Mesh mesh = two_levels(scene_named("furnace.obj"), 0.5, 0.25);
    ASSERT_EQ(mesh.shooters.size(), 24u);
    ASSERT_EQ(mesh.patches.size(), 96u);
    const double rho = reflectance(mesh, mesh.patches[0], 0);
    auto how = settings(256, 1e-6);
    how.form_factor = FormFactorMode::analytic;
    how.sampling_error = 1e-9;

    const auto solution = solution_of(mesh, how);

    for (const double value : solution.radiosity[0])
        EXPECT_NEAR(value * (1 - rho) / std::numbers::pi, 1, 2e-5);
    EXPECT_LT(solution.ledger[0].residual(), 1e-6);
}

/// Shooters of all sizes, chosen at random.
Mesh with_split_shooters(const Scene& scene, const MeshSettings& settings) {
    std::mt19937 random(5);
    Mesh mesh = build_mesh(scene, settings);
    for (std::uint32_t level = 0; level < settings.split_levels; ++level) {
        Splits splits{std::vector<bool>(mesh.patches.size(), false),
                      std::vector<bool>(mesh.shooters.size())};
        for (std::size_t i = 0; i < mesh.shooters.size(); ++i)
            splits.shooters[i] = random() % 3 == 0;
        mesh = split_mesh(scene, settings, mesh, splits);
    }
    return mesh;
}

// Rows of the device, in the reference's full matrix.
struct Rows {
    reference::FormFactorMatrix between_shooters;
    std::vector<std::vector<double>> to_patches;  // [shooter][patch]
};

Rows rows_of(const Mesh& mesh, std::uint32_t resolution) {
    const PatchArrays patches = patch_arrays(mesh);
    const ShooterArrays shooters = shooter_arrays(mesh, patches);
    PipelineSettings how;
    how.resolution = resolution;
    const auto device = mp1map::Device::open("");
    ShotPipeline pipeline(patches, even_light(shooters.polygons), how, device, shooters);
    pipeline.init_plane();
    Rows rows{reference::FormFactorMatrix(mesh.shooters.size()), {}};
    for (std::uint32_t from = 0; from < mesh.shooters.size(); ++from) {
        project_shooter(pipeline, from);
        const auto counts = pipeline.proxel_counts();
        rows.to_patches.emplace_back();
        for (std::uint32_t to = 0; to < mesh.shooters.size(); ++to)
            for (std::uint32_t i = 0; i < mesh.shooters[to].patch_count; ++i) {
                const double factor = counts[mesh.shooters[to].first_patch + i] /
                                      static_cast<double>(pipeline.disk_proxels());
                rows.to_patches.back().push_back(factor);
                rows.between_shooters.at(from, to) += factor;
            }
    }
    return rows;
}

void expect_solution_of_the_full_matrix(const Mesh& mesh) {
    const Rows rows = rows_of(mesh, 64);
    std::vector<double> areas(mesh.shooters.size());
    for (std::size_t i = 0; i < areas.size(); ++i)
        for (std::uint32_t k = 0; k < mesh.shooters[i].patch_count; ++k)
            areas[i] += mesh.area(mesh.patches[mesh.shooters[i].first_patch + k]);

    const auto solution = solution_of(mesh, settings(64, 1e-7));

    for (std::size_t band = 0; band < 3; ++band) {
        std::vector<double> reflectances, emitted;
        for (const Shooter& shooter : mesh.shooters) {
            reflectances.push_back(reflectance(mesh, mesh.patches[shooter.first_patch], band));
            emitted.push_back(emitted_radiosity(mesh, mesh.patches[shooter.first_patch], band));
        }
        const auto full =
            reference::solve(rows.between_shooters, areas, reference::Band{reflectances, emitted});
        std::vector<double> irradiance(mesh.patches.size());
        for (std::size_t from = 0; from < areas.size(); ++from)
            for (std::size_t i = 0; i < irradiance.size(); ++i)
                irradiance[i] += full.radiosity[from] * areas[from] * rows.to_patches[from][i] /
                                 mesh.area(mesh.patches[i]);
        EXPECT_LT(largest_difference(solution.irradiance[band], irradiance), 1e-5);
    }
}

TEST(TwoLevels, GiveTheSolutionOfTheFullMatrix) {
    const Mesh mesh = two_levels(furnished_room(), 1.0, 0.5);
    ASSERT_LT(2 * mesh.shooters.size(), mesh.patches.size());

    expect_solution_of_the_full_matrix(mesh);
}

TEST(TwoLevels, GiveTheSolutionOfTheFullMatrixWithSplitShooters) {
    const MeshSettings settings{.patch_size = 2.0, .element_size = 0.5, .split_levels = 2};
    const Mesh mesh = with_split_shooters(furnished_room(), settings);
    ASSERT_LT(build_mesh(furnished_room(), settings).shooters.size(), mesh.shooters.size());
    ASSERT_LT(mesh.shooters.size(), mesh.patches.size());

    expect_solution_of_the_full_matrix(mesh);
}

void expect_same_bits_for_every_array(const Mesh& mesh) {
    auto how = settings(64, 1e-2);
    how.form_factor = FormFactorMode::analytic;
    const auto first = solution_of(mesh, how);
    for (const Shape& shape : {shapes()[1], shapes()[5]}) {
        how.pe_array = shape.request();

        const auto other = solution_of(mesh, how);

        EXPECT_EQ(other.shots, first.shots) << shape;
        EXPECT_EQ(other.irradiance, first.irradiance) << shape;
        EXPECT_EQ(other.ledger[0].unshot, first.ledger[0].unshot) << shape;
    }
}

TEST(TwoLevels, HaveTheSameBitsForEveryArray) {
    expect_same_bits_for_every_array(two_levels(scene_named("cornell.gltf"), 0.2, 0.07));
}

TEST(TwoLevels, HaveTheSameBitsForEveryArrayWithSplitShooters) {
    expect_same_bits_for_every_array(with_split_shooters(
        scene_named("cornell.gltf"), {.patch_size = 0.2, .element_size = 0.05, .split_levels = 2}));
}

TEST(TwoLevels, StayClosedWithSplitShooters) {
    const MeshSettings settings{.patch_size = 1.4, .element_size = 0.35, .split_levels = 2};
    const Mesh mesh = with_split_shooters(scene_named("lroom.obj"), settings);
    EXPECT_TRUE(mesh.closed);
    auto how = hemirad::test::settings(128, 1e-3);
    how.form_factor = FormFactorMode::analytic;
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, how, device);

    solver.solve(go_on);

    EXPECT_EQ(solver.closure().least, 1.0);
    EXPECT_EQ(solver.closure().most, 1.0);
    for (const Ledger& ledger : solver.solution().ledger) {
        EXPECT_EQ(ledger.escaped, 0);
        EXPECT_LT(ledger.residual(), 1e-6);
    }
}

}  // namespace
}  // namespace hemirad::test::two_levels_test
