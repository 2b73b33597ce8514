#pragma once

#include <glm/vec3.hpp>

namespace hemirad::formfactor {

/// From `start` along the unit vector `along`.
struct Segment {
    glm::dvec3 start, along;
    double length;

    glm::dvec3 at(double s) const { return start + s * along; }
};

/// Integral of ln r from a point along a segment.
double log_distance(const glm::dvec3& point, const Segment& segment);

/// Double integral of ln r between the points of two segments, in closed form where they lie in
/// one plane, touch or overlap; else the outer one by quadrature of about the relative
/// `tolerance`.
double log_distance(const Segment& a, const Segment& b, double tolerance);

}  // namespace hemirad::formfactor
