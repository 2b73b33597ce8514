#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "reference/closed_forms.h"
#include "reference/item_buffer.h"
#include "tests/reference/shapes.h"

/// Points that look at polygons whose factors have a closed form, and how far methods are off.
namespace hemirad::reference {

inline double closed_form(const Shooter& shooter, const Polygon& polygon) {
    return point_to_polygon(shooter.origin, shooter.normal, polygon.corners);
}

/// Nothing in it hides anything else.
struct View {
    Shooter shooter;
    std::vector<Polygon> polygons;
};

/// A triangle of about `size` each, seen by a point in general position.
inline std::vector<View> triangle_views(int count, double size) {
    std::mt19937 random(5);
    std::vector<View> views;
    for (const Polygon& polygon : soup(count, size, 11)) {
        const auto normal = glm::normalize(random_point(random, 1));
        const auto u_axis = glm::normalize(glm::cross(normal, random_point(random, 1)));
        const Shooter shooter{{0.02, -0.01, 0.03}, normal, u_axis};
        if (closed_form(shooter, polygon) > 0) views.push_back({shooter, {polygon}});
    }
    return views;
}

enum class Frame { along_the_walls, turned };

/// From points of the floor into a room of cells x cells quads a wall.
inline std::vector<View> room_views(int count, int cells, Frame frame = Frame::along_the_walls) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> coordinate(-0.9, 0.9);
    std::vector<View> views;
    for (int view = 0; view < count; ++view) {
        const double x = coordinate(random), y = coordinate(random);
        const double angle = frame == Frame::turned ? 4 * coordinate(random) : 0;
        const glm::dvec3 u_axis(std::cos(angle), std::sin(angle), 0);
        views.push_back({{{x, 0.7 * y, -0.5}, {0, 0, 1}, u_axis}, room({1, 0.7, 0.5}, cells)});
    }
    return views;
}

using Method = std::function<PointFactors(const View&, int resolution)>;

inline PointFactors by_hemisphere(const View& view, int resolution) {
    return hemisphere_factors(view.shooter, view.polygons, resolution);
}

inline PointFactors by_hemicube(const View& view, int resolution) {
    return hemicube_factors(view.shooter, view.polygons, resolution);
}

inline Method by_plane(double half_width) {
    return [half_width](const View& view, int resolution) {
        return single_plane_factors(view.shooter, view.polygons, resolution, half_width);
    };
}

/// Resolutions of about so many samples: N^2 pi / 4, 3 N^2 (N even) and N^2.
inline int hemisphere_of(double samples) {
    return int(std::lround(std::sqrt(4 * samples / std::numbers::pi)));
}
inline int hemicube_of(double samples) { return 2 * int(std::lround(std::sqrt(samples / 12))); }
inline int plane_of(double samples) { return int(std::lround(std::sqrt(samples))); }

/// Root of the mean square over all that is seen.
inline double rms_error(const std::vector<View>& views, const Method& method, int resolution) {
    double squares = 0;
    int seen = 0;
    for (const View& view : views) {
        const PointFactors factors = method(view, resolution);
        for (std::size_t polygon = 0; polygon < view.polygons.size(); ++polygon) {
            const double truth = closed_form(view.shooter, view.polygons[polygon]);
            if (truth == 0) continue;
            squares += std::pow(factors.values[polygon] - truth, 2);
            ++seen;
        }
    }
    return std::sqrt(squares / seen);
}

/// Of the least-squares line through log error over log resolution.
inline double slope(const std::vector<int>& resolutions, const std::vector<double>& errors) {
    double x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < resolutions.size(); ++i) {
        const double log_n = std::log(resolutions[i]), log_error = std::log(errors[i]);
        x += log_n, y += log_error, xx += log_n * log_n, xy += log_n * log_error;
    }
    const double count = double(resolutions.size());
    return (count * xy - x * y) / (count * xx - x * x);
}

}  // namespace hemirad::reference
