#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "extremes/stage.h"

/// Scenes of a few patches that meet as badly as patches can.
namespace hemirad::test {

/// Draws a scene in the cube [-1, 1]^3 about a shooter that stays where it is: patch 0, whose frame
/// is known, and two far patches that fix the extent, so that points can be put on proxels' rays.
class BadNeighbours {
  public:
    explicit BadNeighbours(std::uint64_t seed) : random_(seed) {}

    /// A shooter of any size; show it with fixed_patches() to learn its frame.
    Polygon shooter_patch() {
        const double size = log_uniform(1e-6, 0.5);
        const glm::dvec3 centre = 0.4 * in_cube();
        const glm::dvec3 u = direction();
        const glm::dvec3 v = glm::normalize(glm::cross(u, direction()));
        return {{centre - size * u, centre + size * v, centre + size * u, centre - size * v}};
    }
    static std::vector<Polygon> fixed_patches(const Polygon& shooter) {
        const auto corner = [](double s) {
            const glm::dvec3 a(s), b(s, 0.9 * s, s), c(s, s, 0.8 * s);
            return Polygon{{a, b, c, c}};
        };
        return {shooter, corner(1), corner(-1)};
    }

    /// `frame` in world coordinates.
    std::vector<Polygon> scene(const Polygon& shooter, const reference::Shooter& frame,
                               int resolution) {
        frame_ = frame;
        resolution_ = resolution;
        polygons_ = fixed_patches(shooter);
        const int count = 1 + whole(10);
        for (int i = 0; i < count; ++i) polygons_.push_back(any_polygon());
        return polygons_;
    }

  private:
    int whole(int below) { return static_cast<int>(random_() % static_cast<unsigned>(below)); }
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    double log_uniform(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    glm::dvec3 in_cube() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
    glm::dvec3 direction() {
        for (;;) {
            const auto point = in_cube();
            const double length = glm::length(point);
            if (length > 0.1 && length < 1) return point / length;
        }
    }
    // From what the grid can hardly tell from the shooter's own place; most of them farther off.
    double some_distance() { return log_uniform(whole(4) == 0 ? 1e-8 : 1e-3, 1.5); }
    static glm::dvec3 into_cube(const glm::dvec3& p) { return glm::clamp(p, -1.0, 1.0); }
    static bool is_in_cube(const glm::dvec3& p) { return p == into_cube(p); }

    glm::dvec3 on_a_ray() {
        for (;;) {
            const int column = whole(resolution_), row = whole(resolution_);
            if (reference::in_disk(column, row, resolution_))
                return frame_.origin + some_distance() * ray_of(frame_, column, row, resolution_);
        }
    }
    glm::dvec3 in_the_shooters_plane() {
        const glm::dvec3 v_axis = glm::cross(frame_.normal, frame_.u_axis);
        const double angle = uniform(0, 2 * std::numbers::pi);
        return frame_.origin +
               some_distance() * (std::cos(angle) * frame_.u_axis + std::sin(angle) * v_axis);
    }
    glm::dvec3 a_corner() { return polygons_[whole(int(polygons_.size()))].corners[whole(4)]; }
    glm::dvec3 on_an_edge() {
        const auto& corners = polygons_[whole(int(polygons_.size()))].corners;
        const int k = whole(4);
        return corners[k] + uniform(0, 1) * (corners[(k + 1) % 4] - corners[k]);
    }
    glm::dvec3 any_point() {
        switch (whole(9)) {
            case 0:
                return in_cube();
            case 1:
                return on_a_ray();
            case 2:
                return on_a_ray() + log_uniform(1e-10, 1e-2) * direction();
            case 3:
                return a_corner();
            case 4:
                return on_an_edge();
            case 5:
                return a_corner() + log_uniform(1e-10, 1e-2) * direction();
            case 6:
                return in_the_shooters_plane();
            case 7:
                return in_the_shooters_plane() + log_uniform(1e-10, 1e-4) * frame_.normal;
            default:
                return frame_.origin + some_distance() * direction();
        }
    }

    // The third corner: anywhere, of the size of the first edge, or so close to it that the patch
    // is a sliver or nothing.
    glm::dvec3 third_corner(const glm::dvec3& a, const glm::dvec3& b) {
        const double length = glm::length(b - a);
        const auto beside = uniform(-0.5, 1.5) * (b - a);
        switch (whole(8)) {
            case 0:
                return a;
            case 1:
                return into_cube(a + beside);
            case 2:
            case 3:
                return into_cube(a + beside + log_uniform(1e-9, 1) * length * direction());
            case 4:
                return into_cube(a + length * direction());
            default:
                return into_cube(any_point());
        }
    }
    // Products of doubles tell the normal of a sliver, aspect a, to within 4 a 2^-53; beyond 1e7
    // that is no less than what floats do to it. No area at all is as good as known.
    static bool has_a_sure_normal(const Polygon& polygon) {
        double longest = 0;
        for (const auto& a : polygon.corners)
            for (const auto& b : polygon.corners) longest = std::max(longest, glm::distance(a, b));
        const double area = reference::area(polygon);
        return area == 0 || longest * longest < 1e7 * area;
    }
    // The grid, 2^-30 of half of the cube, makes a point of what is shorter, and a strip of a
    // patch.
    static bool has_edges_on_the_grid(const Polygon& polygon) {
        for (std::size_t k = 0; k < 4; ++k) {
            const double length = glm::distance(polygon.corners[k], polygon.corners[(k + 1) % 4]);
            if (length > 0 && length < 16 * 0x1p-29) return false;
        }
        return true;
    }
    Polygon any_polygon() {
        for (;;) {
            const Polygon polygon = drawn_polygon();
            if (has_a_sure_normal(polygon) && has_edges_on_the_grid(polygon)) return polygon;
        }
    }
    Polygon drawn_polygon() {
        if (whole(12) == 0) return polygons_[whole(int(polygons_.size()))];
        const auto a = into_cube(any_point());
        const auto b = whole(2) == 0 ? into_cube(any_point())
                                     : into_cube(a + log_uniform(1e-10, 1) * direction());
        const auto c = third_corner(a, b);
        const auto d = a + (c - b);
        const bool quad = whole(2) == 0 && is_in_cube(d);
        const Polygon front{{a, b, c, quad ? d : c}};
        return faces_away(front) && whole(4) != 0 ? reversed(front) : front;
    }
    bool faces_away(const Polygon& polygon) const {
        return glm::dot(reference::normal(polygon), frame_.origin - polygon.corners[0]) < 0;
    }
    static Polygon reversed(const Polygon& polygon) {
        const auto& c = polygon.corners;
        if (polygon.is_triangle()) return {{c[1], c[0], c[2], c[2]}};
        return {{c[3], c[2], c[1], c[0]}};
    }

    std::mt19937_64 random_;
    reference::Shooter frame_{};
    int resolution_ = 0;
    std::vector<Polygon> polygons_;
};

}  // namespace hemirad::test
