#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "support/probe.h"

/// Bounding rectangles in double precision, from the circle that an arc is part of and not from
/// the ellipse of app. B.
namespace hemirad::test {

struct Interval {
    double least = 2, most = -2;

    void include(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

struct ExactBounds {
    Interval u, v;
    double distance = std::numeric_limits<double>::max();  // of the edges' nearest point
};

/// The arc is x(t) = cos t * e + sin t * f for t in [0, angle]; a coordinate of it is
/// R cos(t - phase), extreme where t is the phase or the phase plus pi.
inline void include_coordinate(Interval& interval, double e, double f, double angle) {
    interval.include(e);
    interval.include(e * std::cos(angle) + f * std::sin(angle));
    const double radius = std::hypot(e, f), phase = std::atan2(f, e);
    for (const int turn : {-1, 0, 1})
        if (const double t = phase + turn * std::numbers::pi; t > 0 && t < angle)
            interval.include(turn == 0 ? radius : -radius);
}

inline void include_arc(ExactBounds& bounds, const glm::dvec3& a, const glm::dvec3& b) {
    const auto e = glm::normalize(a), normal = glm::cross(a, b);
    const double sine = glm::length(normal);
    if (sine == 0) {
        bounds.u.include(e.x);
        bounds.v.include(e.y);
        return;
    }
    const auto f = glm::cross(normal / sine, e);
    const double angle = std::atan2(sine, glm::dot(a, b));
    include_coordinate(bounds.u, e.x, f.x, angle);
    include_coordinate(bounds.v, e.y, f.y, angle);
}

inline double distance_to(const glm::dvec3& a, const glm::dvec3& b) {
    const auto d = b - a;
    const double squared = glm::dot(d, d);
    const double t = squared > 0 ? std::clamp(-glm::dot(a, d) / squared, 0.0, 1.0) : 0;
    return glm::length(a + t * d);
}

/// Of the arcs of a polygon, of which only what is not below z = 0 counts.
inline ExactBounds exact_bounds(const std::vector<glm::dvec3>& corners) {
    std::vector<glm::dvec3> seen;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto &p = corners[k], &q = corners[(k + 1) % corners.size()];
        if (p.z >= 0) seen.push_back(p);
        if ((p.z < 0) != (q.z < 0)) {
            auto crossing = p + (q - p) * (p.z / (p.z - q.z));
            crossing.z = 0;
            seen.push_back(crossing);
        }
    }
    ExactBounds bounds;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        const auto &p = seen[k], &q = seen[(k + 1) % seen.size()];
        include_arc(bounds, p, q);
        bounds.distance = std::min(bounds.distance, distance_to(p, q));
    }
    return bounds;
}

/// Proxels of a range beyond those whose centres lie in the interval, at its two ends; negative
/// where it lacks some.
struct Excess {
    int before, after;
};

inline Excess excess(std::uint32_t range, const Interval& interval, std::uint32_t resolution) {
    const double half = 0.5 * resolution, centre = half - 0.5;
    const int last = static_cast<int>(resolution) - 1;
    const int exact_first =
        std::max(0, static_cast<int>(std::ceil(interval.least * half + centre)));
    const int exact_last =
        std::min(last, static_cast<int>(std::floor(interval.most * half + centre)));
    const int first_proxel = range & 0xffff, last_proxel = range >> 16;
    if (exact_first > exact_last) {  // between two centres: no proxel to lose
        const bool empty = last_proxel < first_proxel;
        return empty ? Excess{0, 0} : Excess{exact_first - first_proxel, last_proxel - exact_last};
    }
    return {exact_first - first_proxel, last_proxel - exact_last};
}

/// What a probe of bounds.cl found: one rectangle an arc, or a patch.
struct DeviceBounds {
    std::vector<float> values;          // [u least, u most, v least, v most][count]
    std::vector<std::uint32_t> ranges;  // [columns, rows][count]
};

}  // namespace hemirad::test
