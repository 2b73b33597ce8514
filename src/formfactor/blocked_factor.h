#pragma once

#include <span>

#include "formfactor/polygon_factors.h"

namespace hemirad {

/// A factor and a bound of its error.
struct Estimate {
    double value, error;
};

/// F from one polygon to another past others that may stand in between. From a point the visible
/// part of a polygon is exact: convex parts, cut by the cones of the blockers that face the point
/// (sec. 1.5.1: a patch seen from behind hides nothing). The points lie on that of the two polygons
/// on which shadows are softer, adaptively, until the estimated error is below `target_error`, or
/// `most_points` have been looked from. Only blockers that face `from` count, from either side.
Estimate blocked_polygon_to_polygon(std::span<const glm::dvec3> from,
                                    std::span<const glm::dvec3> to,
                                    std::span<const ConvexPolygon> blockers, double target_error,
                                    int most_points = 100000);

/// The same where `unblocked`, polygon_to_polygon(from, to), is known.
Estimate blocked_polygon_to_polygon(std::span<const glm::dvec3> from,
                                    std::span<const glm::dvec3> to, double unblocked,
                                    std::span<const ConvexPolygon> blockers, double target_error,
                                    int most_points);

}  // namespace hemirad
