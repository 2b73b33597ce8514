#include "formfactor/factor_surfaces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace hemirad::factor_surfaces_test {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;

/// Squares of 1 m beside each other in one plane, of objects and materials as given.
struct Tile {
    std::uint32_t object, material;
};

Scene tiles(const std::vector<Tile>& tiles) {
    Scene scene;
    scene.file = "tiles.obj";
    scene.bands = {"R", "G", "B"};
    scene.objects = {"floor", "rug", "floor"};
    scene.materials = {{"black", {0, 0, 0}, {0, 0, 0}},
                       {"grey", {0.5, 0.5, 0.5}, {0, 0, 0}},
                       {"pink", {0.9, 0.6, 0.6}, {0, 0, 0}}};
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        const auto x = double(i);
        for (const glm::dvec3& p : {glm::dvec3(x, 0, 0), glm::dvec3(x + 1, 0, 0),
                                    glm::dvec3(x + 1, 1, 0), glm::dvec3(x, 1, 0)})
            scene.positions.push_back(p);
        scene.faces.push_back(
            {{first, first + 1, first + 2, first + 3}, tiles[i].material, tiles[i].object});
    }
    return scene;
}

Mesh mesh_of(const Scene& scene, Backfaces backfaces = Backfaces::cull) {
    return build_mesh(scene, {.patch_size = INFINITY, .backfaces = backfaces});
}

FactorSurfaces named(const Scene& scene, Backfaces backfaces = Backfaces::cull) {
    return named_surfaces(scene, mesh_of(scene, backfaces));
}

TEST(NamedSurfaces, AreObjectsInFileOrderOneForEachName) {
    const Scene scene = tiles({{1, 0}, {0, 0}, {2, 1}, {1, 0}});

    const FactorSurfaces surfaces = named(scene);

    EXPECT_THAT(surfaces.names, ElementsAre("floor", "rug"));
    EXPECT_THAT(surfaces.of_patch, ElementsAre(1, 0, 0, 1));
    EXPECT_THAT(surfaces.as_from, ElementsAre(true, true));
}

TEST(NamedSurfaces, AreMaterialsWhereThereIsOneObject) {
    Scene scene = tiles({{0, 2}, {0, 1}, {0, 2}});
    scene.objects = {"default"};

    EXPECT_THAT(named(scene).names, ElementsAre("pink", "grey"));
}

TEST(NamedSurfaces, AreTheObjectWhereThereIsOneMaterialToo) {
    Scene scene = tiles({{0, 2}, {0, 2}});
    scene.objects = {"default"};

    EXPECT_THAT(named(scene).names, ElementsAre("default"));
}

TEST(NamedSurfaces, BacksComeLastAndAreNoRows) {
    const Scene scene = tiles({{0, 1}, {1, 1}});

    const FactorSurfaces surfaces = named(scene, Backfaces::block);

    EXPECT_THAT(surfaces.names, ElementsAre("floor", "rug", "floor (back)", "rug (back)"));
    EXPECT_THAT(surfaces.is_back, ElementsAre(false, false, true, true));
    EXPECT_THAT(surfaces.as_from, ElementsAre(true, true, false, false));
    EXPECT_THAT(surfaces.as_to, ElementsAre(true, true, true, true));
}

TEST(NamedSurfaces, BacksOfDoubleSidedMaterialsAreRows) {
    Scene scene = tiles({{0, 1}});
    scene.materials[1].double_sided = true;

    EXPECT_THAT(named(scene).as_from, ElementsAre(true, true));
}

TEST(NamedSurfaces, ObstructionsAreNeitherRowsNorColumns) {
    Scene scene = tiles({{0, 1}, {1, 1}});
    scene.obstructions = {1};

    const FactorSurfaces surfaces = named(scene, Backfaces::block);

    EXPECT_THAT(surfaces.as_from, ElementsAre(true, false, false, false));
    EXPECT_THAT(surfaces.as_to, ElementsAre(true, false, true, false));
}

TEST(NamedSurfaces, TheEmittanceIsTheMeanOverBandsAndArea) {
    Scene scene = tiles({{0, 1}, {0, 1}, {0, 0}, {1, 2}});
    scene.positions[10].y = scene.positions[11].y = 3;  // the black one

    EXPECT_THAT(named(scene).emittance, ElementsAre(DoubleEq((0.5 + 0.5 + 3) / 5), DoubleEq(0.3)));
}

TEST(SinglePatches, AreNumberedFrom0) {
    const Scene scene = tiles({{0, 1}, {0, 0}});

    const FactorSurfaces surfaces = single_patches(scene, mesh_of(scene));

    EXPECT_THAT(surfaces.names, ElementsAre("#0", "#1"));
    EXPECT_THAT(surfaces.of_patch, ElementsAre(0, 1));
    EXPECT_THAT(surfaces.emittance, ElementsAre(0.5, 1));
}

/// Three patches of which the first two are surface 0.
FactorSurfaces two_and_one() {
    return {{"a", "b"}, {0, 0, 1}, {1, 1}, {false, false}, {true, true}, {true, true}};
}

TEST(Gathered, SumsOverWhatReceivesAndAveragesOverWhatSends) {
    FormFactors factors{{0, 1, 2},
                        {{{1, 0.01F, 0.2}, {2, 0.02F, 0.4}}, {{2, 0.03F, 0.1}}, {{0, 0, 0.3}}},
                        {0.4, 0.9, 0.7},
                        {1, 3, 2}};

    const FormFactors sums = gathered(factors, two_and_one());

    EXPECT_THAT(sums.area, ElementsAre(4, 2));
    EXPECT_THAT(sums.from, ElementsAre(0, 1));
    EXPECT_DOUBLE_EQ(sums.at(0, 0), 0.25 * 0.2);
    EXPECT_DOUBLE_EQ(sums.at(0, 1), 0.25 * 0.4 + 0.75 * 0.1);
    EXPECT_DOUBLE_EQ(sums.at(1, 0), 0.3);
    EXPECT_EQ(sums.rows[1].size(), 1u);
    EXPECT_THAT(sums.outside, ElementsAre(DoubleEq(0.25 * 0.4 + 0.75 * 0.9), DoubleEq(0.7)));
    EXPECT_FLOAT_EQ(sums.rows[0][1].error, 0.25F * 0.02F + 0.75F * 0.03F);
}

TEST(Gathered, RowsAreInOrderOfTheSurfaces) {
    FactorSurfaces turned = two_and_one();
    turned.of_patch = {1, 1, 0};
    const FormFactors factors{{2}, {{{0, 0, 0.1}, {2, 0, 0.2}}}, {0.7}, {1, 3, 2}};

    const FormFactors sums = gathered(factors, turned);

    EXPECT_DOUBLE_EQ(sums.at(0, 0), 0.2);
    EXPECT_DOUBLE_EQ(sums.at(0, 1), 0.1);
}

TEST(Gathered, SurfacesWithoutRowsHaveNone) {
    const FormFactors factors{{2}, {{{0, 0, 0.1}, {1, 0, 0.2}}}, {0.7}, {1, 3, 2}};

    const FormFactors sums = gathered(factors, two_and_one());

    EXPECT_THAT(sums.from, ElementsAre(1));
    EXPECT_DOUBLE_EQ(sums.at(0, 0), 0.1 + 0.2);
    EXPECT_THAT(sums.area, ElementsAre(4, 2));
}

TEST(AmongListed, IsTheSquareMatrixOfThoseThatAreRowsAndColumns) {
    FactorSurfaces surfaces{{"a", "b", "c"},       {0, 1, 2},           {1, 1, 1},
                            {false, false, false}, {true, false, true}, {true, true, true}};
    const FormFactors factors{{0, 1, 2},
                              {{{1, 0, 0.5}, {2, 0, 0.3}}, {{0, 0, 0.5}}, {{0, 0, 0.15}}},
                              {0.2, 0.5, 0.85},
                              {1, 1, 2}};

    const FormFactors square = among_listed(factors, surfaces);

    EXPECT_THAT(square.from, ElementsAre(0, 1));
    EXPECT_THAT(square.area, ElementsAre(1, 2));
    EXPECT_DOUBLE_EQ(square.at(0, 1), 0.3);
    EXPECT_DOUBLE_EQ(square.at(1, 0), 0.15);
    EXPECT_EQ(square.rows[0].size(), 1u);
    EXPECT_NEAR(reciprocity_error(square), 0, 1e-15);
}

}  // namespace
}  // namespace hemirad::factor_surfaces_test
