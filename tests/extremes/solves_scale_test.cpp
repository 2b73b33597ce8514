#include "extremes/solves_support.h"
#include "lightmap/rasterize.h"

// What a solution says does not depend on where the scene lies, how it is turned or in which unit
// it is measured: emission is radiance, so irradiance has no length in it.
namespace hemirad::test::solves_scale_test {
namespace {

constexpr double kPatchSize = 0.75;
constexpr std::uint32_t kResolution = 64;
constexpr double kQuantum = 1e-7;  // m, of the coordinates: doubles have it as far as we go
constexpr double kRoomLength = 6;  // m, of furnished_room()
constexpr double kDistances[] = {1, 1e3, 1e5, 1e7};  // from the origin, in lengths of the room

SolverSettings how(FormFactorMode mode, std::uint32_t resolution = kResolution) {
    return settings(resolution, mode, 1e-2);
}

class Scale : public testing::TestWithParam<FormFactorMode> {};

INSTANTIATE_TEST_SUITE_P(Modes, Scale,
                         testing::Values(FormFactorMode::count, FormFactorMode::analytic),
                         [](const auto& mode) { return name_of(mode.param); });

Lightmap lightmap_of(const Scene& scene, double scale, FormFactorMode mode) {
    const Mesh mesh = meshed(scaled(scene, scale), kPatchSize * scale);
    return rasterize(mesh, solution_of(mesh, how(mode)), lay_out_charts(mesh),
                     Quantity::irradiance);
}

TEST_P(Scale, ByAPowerOfTwoLeavesEveryBitOfTheLightmap) {
    std::mt19937 random(6);
    const Scene scene = rotated(furnished_room(), random_rotation(random));
    const Lightmap metres = lightmap_of(scene, 1, GetParam());

    for (const int power : {-200, -20, -13, -1, 1, 10, 20, 200}) {
        const Lightmap other = lightmap_of(scene, std::ldexp(1.0, power), GetParam());
        EXPECT_EQ(other.values, metres.values) << "2^" << power;
        EXPECT_EQ(other.coverage, metres.coverage) << "2^" << power;
    }
}

/// [band][face] area means of irradiance over the fronts of a scene's faces.
std::vector<std::vector<double>> face_means(const Mesh& mesh, const Solution& solution) {
    std::vector<std::vector<double>> means;
    for (const auto& irradiance : solution.irradiance) {
        std::vector<double> flux(mesh.face_count), area(mesh.face_count);
        for (const Fragment& fragment : mesh.fragments) {
            flux[fragment.face] += fragment.area * irradiance[fragment.patch];
            area[fragment.face] += fragment.area;
        }
        for (std::size_t face = 0; face < flux.size(); ++face) flux[face] /= area[face];
        means.push_back(std::move(flux));
    }
    return means;
}

double largest_change(const std::vector<std::vector<double>>& from,
                      const std::vector<std::vector<double>>& to) {
    double largest = 0;
    for (std::size_t band = 0; band < from.size(); ++band)
        largest = std::max(largest, largest_difference(to[band], from[band]));
    return largest;
}

/// What a solution depends on besides the scene: how its plane is sampled.
class Resampled : public Scale {
  protected:
    std::vector<std::vector<double>> means(Scene scene, double patch_size = kPatchSize,
                                           std::uint32_t resolution = kResolution) const {
        scene.quantum = kQuantum * patch_size / kPatchSize;
        const Mesh mesh = meshed(scene, patch_size);
        const Solution solution = solution_of(mesh, how(GetParam(), resolution));
        expect_numbers(solution);
        EXPECT_EQ(solution.ledger[0].escaped, 0);
        EXPECT_LT(largest_residual(solution), 1e-6);
        return face_means(mesh, solution);
    }

    /// The least change that another sampling of the same plane makes, of the face that changes
    /// most: no transformation may do more, as all that is left of it on the device is the rounding
    /// of coordinates, which decides on proxels that an edge meets in their centres.
    double aliasing(const Scene& scene) const {
        const auto here = means(scene);
        return std::min(largest_change(here, means(scene, kPatchSize, kResolution - 2)),
                        largest_change(here, means(scene, kPatchSize, kResolution + 2)));
    }
};

INSTANTIATE_TEST_SUITE_P(Modes, Resampled,
                         testing::Values(FormFactorMode::count, FormFactorMode::analytic),
                         [](const auto& mode) { return name_of(mode.param); });

TEST_P(Resampled, AliasesMoreThanAnyTransformation) {
    const Scene scene = furnished_room();
    const auto here = means(scene);
    const double bound = aliasing(scene);
    RecordProperty("aliasing", std::to_string(bound));
    std::mt19937 random(3);

    for (const double factor : {1e-6, 0.3, 7.0, 1e6})
        EXPECT_LT(largest_change(here, means(scaled(scene, factor), kPatchSize * factor)), bound)
            << "factor " << factor;
    for (int i = 0; i < 3; ++i)
        EXPECT_LT(largest_change(here, means(rotated(scene, random_rotation(random)))), bound)
            << "rotation " << i;
    for (const double sizes : kDistances) {
        const glm::dvec3 by = sizes * kRoomLength * glm::dvec3(1, -0.7, 0.3);
        EXPECT_LT(largest_change(here, means(moved(scene, by))), bound) << sizes << " sizes away";
    }
}

}  // namespace
}  // namespace hemirad::test::solves_scale_test
