#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "scene/scenes_by_hand.h"
#include "support/seconds_since.h"

namespace hemirad::mesh_junctions_test {
namespace {

using Faces = std::vector<std::vector<glm::dvec3>>;

/// A room whose floor is five tiles laid as a pinwheel: each of the inner corners lies on the edge
/// of a tile whose end lies on the edge of the next.
Faces pinwheel_room() {
    Faces faces = room({0, 0, 0}, {3, 3, 2});
    faces.erase(faces.begin());
    for (const auto& tile : {rectangle(0, 0, 2, 1), rectangle(2, 0, 3, 2), rectangle(1, 2, 3, 3),
                             rectangle(0, 1, 1, 3), rectangle(1, 1, 2, 2)})
        faces.push_back(tile);
    return faces;
}

/// A vertex and the ends of the edge that it lies on.
struct Junction {
    glm::dvec3 at, from, to;
};

const std::vector<Junction> kPinwheelJunctions{
    {{2, 0, 0}, {0, 0, 0}, {3, 0, 0}}, {{3, 2, 0}, {3, 0, 0}, {3, 3, 0}},
    {{1, 3, 0}, {0, 3, 0}, {3, 3, 0}}, {{0, 1, 0}, {0, 0, 0}, {0, 3, 0}},
    {{2, 1, 0}, {2, 0, 0}, {2, 2, 0}}, {{2, 2, 0}, {1, 2, 0}, {3, 2, 0}},
    {{1, 2, 0}, {1, 1, 0}, {1, 3, 0}}, {{1, 1, 0}, {0, 1, 0}, {2, 1, 0}}};

glm::dvec3 nearest_vertex(const Mesh& mesh, const glm::dvec3& to) {
    return *std::ranges::min_element(mesh.vertices, {},
                                     [&](const glm::dvec3& v) { return glm::distance(v, to); });
}

double distance_to_line(const glm::dvec3& p, const glm::dvec3& from, const glm::dvec3& to) {
    return glm::length(glm::cross(p - from, to - from)) / glm::distance(from, to);
}

class Turn {
  public:
    explicit Turn(unsigned seed) : random_(seed) {
        std::normal_distribution<double> any;
        rotation_ =
            glm::normalize(glm::dquat(any(random_), any(random_), any(random_), any(random_)));
        shift_ = {any(random_), any(random_), any(random_)};
    }
    glm::dvec3 operator()(const glm::dvec3& p) const { return rotation_ * p + shift_; }
    Scene floats_of(Faces faces) const {
        for (auto& face : faces)
            for (auto& p : face) p = glm::dvec3(glm::vec3((*this)(p)));
        return scene_of(faces);
    }

  private:
    std::mt19937 random_;
    glm::dquat rotation_;
    glm::dvec3 shift_;
};

TEST(Junctions, RoundedToFloatsAreMovedOntoTheirEdges) {
    for (unsigned seed = 0; seed < 100; ++seed) {
        const Turn turn(seed);

        const Mesh mesh = mesh_of(turn.floats_of(pinwheel_room()), kUncut);

        EXPECT_TRUE(mesh.closed) << seed;
        EXPECT_GT(mesh.input.moved, 0u);
        EXPECT_LE(mesh.input.moved, kPinwheelJunctions.size());
        for (const auto& [at, from, to] : kPinwheelJunctions)
            EXPECT_LT(
                distance_to_line(nearest_vertex(mesh, turn(at)), nearest_vertex(mesh, turn(from)),
                                 nearest_vertex(mesh, turn(to))),
                0x1p-51 * 8)
                << seed;
    }
}

TEST(Junctions, ThatAreExactStayBitForBit) {
    EXPECT_EQ(mesh_of(pinwheel_room(), 0.3).input.moved, 0u);
}

TEST(Junctions, LeaveVerticesBeyondThePrecisionWhereTheyAre) {
    for (const double crack : {0.9, 1.1}) {
        const double beside = crack * 8 * 0x1p-23 * 2;
        const Faces faces{rectangle(0, 0, 2, 1),
                          {{0, 1, 0}, {1, 1 + beside, 0}, {1, 2, 0}, {0, 2, 0}}};

        EXPECT_EQ(mesh_of(faces, kUncut).input.moved, crack < 1 ? 1u : 0u);
    }
}

TEST(Junctions, DoNotDrawVerticesOfClosedSolidsOntoASheetsEdge) {
    Faces faces = solid_box({0.5, 1e-7, 0}, {0.7, 1, 1});
    faces.push_back({{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {0, -1, 0}});

    EXPECT_EQ(mesh_of(faces, kUncut).input.moved, 0u);
}

TEST(Junctions, DoNotCollapseNeedles) {
    // The needle's tip lies beside an edge, and the needle is hardly wider than the precision.
    const double p = 8 * 0x1p-23;
    const Faces faces{rectangle(0, 0, 1, 1),
                      {{0.5, 1 + 0.9 * p, 0}, {0.4, 1 + 1.5 * p, 0}, {0.2, 1 + 3.6 * p, 0}}};

    const Mesh mesh = mesh_of(faces, kUncut);

    for (const Patch& patch : mesh.patches) EXPECT_EQ(std::abs(mesh.normal(patch).z), 1);
    EXPECT_EQ(mesh.input.moved, 0u);
}

TEST(Junctions, OfAHundredThousandLooseTrianglesTakeSeconds) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0, 1);
    Scene scene = empty_scene();
    for (int i = 0; i < 100000; ++i) {
        const glm::dvec3 at(any(random), any(random), any(random));
        const auto corner = [&] {
            return at + 0.02 * glm::dvec3(any(random), any(random), any(random));
        };
        add_face(scene, {corner(), corner(), corner()});
    }
    const auto start = std::clock();

    mesh_of(scene, kUncut);

    EXPECT_LT(test::seconds_since(start), 10);
}

TEST(Junctions, OfVanesRoundOneVertexTakeSeconds) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto somewhere = [&] { return glm::dvec3(any(random), any(random), any(random)); };
    Scene scene = empty_scene();
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 at = glm::normalize(somewhere());
        add_face(scene, {{0, 0, 0}, at, at + 0.02 * somewhere()});
    }
    const auto start = std::clock();

    mesh_of(scene, kUncut);

    EXPECT_LT(test::seconds_since(start), 5);
}

TEST(Junctions, OfAPlankFloorTakeSeconds) {
    Scene scene = empty_scene();
    constexpr int kPlanks = 50000;
    for (int i = 0; i < kPlanks; ++i)
        add_face(scene, rectangle(1e-3 * i, 0, 1e-3 * i + 0.9e-3, 50));
    const auto start = std::clock();

    mesh_of(scene, kUncut);

    EXPECT_LT(test::seconds_since(start), 10);
}

}  // namespace
}  // namespace hemirad::mesh_junctions_test
