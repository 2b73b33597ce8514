#include "reference/item_buffer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>

// A sample is a direction x in the frame of its plane: (x, y, 1) through a pixel, or (u, v, w) of
// unit length through a proxel. For a polygon with corners p, q, ... relative to the point,
//     dot(cross(q, p), x) >= 0 at every edge is inside (app. A), and
//     dot(-normal, x) / height is 1 / distance in units of |x|.
// Both are linear in x; along one x the greatest reciprocal is the nearest.
namespace hemirad::reference {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// First and last, both included; empty where last < first.
struct Range {
    int first = 0, last = -1;
};

struct Bounds {
    Range columns, rows;
};

using Corners = std::array<dvec3, 4>;

// Indices whose centres least + (index + 1/2) * step may lie in [low, high]; one more on either
// side for rounding.
Range indices(double low, double high, double least, double step, int count) {
    if (low > high) return {};
    const double first = std::floor((low - least) / step - 0.5) - 1;
    const double last = std::ceil((high - least) / step - 0.5) + 1;
    return {int(std::clamp(first, 0.0, double(count))),
            int(std::clamp(last, -1.0, double(count - 1)))};
}

/// A plane at distance 1 along the frame's third axis.
class Pixels {
  public:
    Pixels(const dmat3& axes, const dvec3& shooter_normal, dvec2 least, dvec2 most, glm::ivec2 size)
        : world_from_plane_(axes),
          shooter_normal_(glm::transpose(axes) * shooter_normal),
          least_(least),
          most_(most),
          step_((most - least) / dvec2(size)),
          size_(size) {}

    const dmat3& world_from_plane() const { return world_from_plane_; }
    glm::ivec2 size() const { return size_; }

    dvec3 direction(int column, int row) const {
        return {least_.x + (column + 0.5) * step_.x, least_.y + (row + 0.5) * step_.y, 1};
    }

    // Delta form factor: cos cos' / (pi r^2) dA, with cos' = 1 / r at the pixel.
    double weight(int column, int row) const {
        const dvec3 x = direction(column, row);
        const double rr = glm::dot(x, x);
        return glm::dot(shooter_normal_, x) / (std::numbers::pi * rr * rr) * step_.x * step_.y;
    }

    Bounds bounds(const Corners& corners) const;

  private:
    dmat3 world_from_plane_;
    dvec3 shooter_normal_;
    dvec2 least_, most_, step_;
    glm::ivec2 size_;
};

std::vector<dvec3> clip(const std::vector<dvec3>& corners, const dvec3& inwards) {
    std::vector<dvec3> clipped;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const dvec3 p = corners[k];
        const dvec3 q = corners[(k + 1) % corners.size()];
        const double in_p = glm::dot(inwards, p);
        const double in_q = glm::dot(inwards, q);
        if (in_p >= 0) clipped.push_back(p);
        if ((in_p >= 0) != (in_q >= 0)) clipped.push_back(p + in_p / (in_p - in_q) * (q - p));
    }
    return clipped;
}

// Inside the pyramid of the plane's outline z is positive but at its apex, which no polygon seen
// from its front contains.
Bounds Pixels::bounds(const Corners& corners) const {
    std::vector<dvec3> seen(corners.begin(), corners.end());
    for (const dvec3& inwards : {dvec3(1, 0, -least_.x), dvec3(-1, 0, most_.x),
                                 dvec3(0, 1, -least_.y), dvec3(0, -1, most_.y)})
        seen = clip(seen, inwards);
    dvec2 low(kInfinity), high(-kInfinity);
    for (const dvec3& corner : seen) {
        if (corner.z <= 0) return {{0, size_.x - 1}, {0, size_.y - 1}};
        low = glm::min(low, dvec2(corner) / corner.z);
        high = glm::max(high, dvec2(corner) / corner.z);
    }
    return {indices(low.x, high.x, least_.x, step_.x, size_.x),
            indices(low.y, high.y, least_.y, step_.y, size_.y)};
}

/// The square around the base disk; w is stored once a proxel (sec. 1.5.3), 0 outside the disk.
class Proxels {
  public:
    Proxels(const dmat3& axes, int resolution)
        : world_from_plane_(axes),
          resolution_(resolution),
          weight_(1 / double(disk_proxel_count(resolution))),
          w_(std::size_t(resolution) * resolution) {
        for (int row = 0; row < resolution; ++row)
            for (int column = 0; column < resolution; ++column)
                if (in_disk(column, row, resolution)) w_[at(column, row)] = w(column, row);
    }

    const dmat3& world_from_plane() const { return world_from_plane_; }
    glm::ivec2 size() const { return glm::ivec2(resolution_); }
    dvec3 direction(int column, int row) const {
        return {centre(column), centre(row), w_[at(column, row)]};
    }
    double weight(int column, int row) const { return w_[at(column, row)] > 0 ? weight_ : 0; }
    Bounds bounds(const Corners& corners) const;

  private:
    std::size_t at(int column, int row) const { return std::size_t(row) * resolution_ + column; }
    double centre(int index) const { return double(2 * index + 1 - resolution_) / resolution_; }
    double w(int column, int row) const {
        const double u = centre(column), v = centre(row);
        return std::sqrt(std::max(0.0, 1 - u * u - v * v));
    }

    dmat3 world_from_plane_;
    int resolution_;
    double weight_;
    std::vector<double> w_;
};

// The polygon lies in a ball, the ball in a cone of directions.
Bounds Proxels::bounds(const Corners& corners) const {
    const Bounds whole{{0, resolution_ - 1}, {0, resolution_ - 1}};
    const dvec3 middle = (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0;
    double radius = 0;
    for (const dvec3& corner : corners) radius = std::max(radius, glm::distance(corner, middle));
    const double away = glm::length(middle);
    if (away <= radius) return whole;
    const double half_angle = std::asin(radius / away);
    const auto along = [&](double component) {
        const double angle = std::acos(std::clamp(component / away, -1.0, 1.0));
        return indices(std::cos(std::min(std::numbers::pi, angle + half_angle)),
                       std::cos(std::max(0.0, angle - half_angle)), -1, 2.0 / resolution_,
                       resolution_);
    };
    return {along(middle.x), along(middle.y)};
}

struct Target {
    int polygon;
    Corners edges;  ///< cross(q, p)
    int edge_count;
    dvec3 reciprocal;  ///< 1 / distance is dot(reciprocal, x)
    double of_patch;   ///< 1 / distance of the corners' mean
    Bounds bounds;
};

Corners seen_from(const Polygon& polygon, const dvec3& origin, const dmat3& world_from_plane) {
    Corners corners;
    for (std::size_t k = 0; k < corners.size(); ++k)
        corners[k] = glm::transpose(world_from_plane) * (polygon.corners[k] - origin);
    return corners;
}

void set_edges(Target& target, const Corners& corners) {
    target.edge_count = 0;
    for (std::size_t k = 0; k < corners.size(); ++k)
        if (const dvec3 q = corners[(k + 1) % corners.size()]; q != corners[k])
            target.edges[target.edge_count++] = glm::cross(q, corners[k]);
}

template <class Samples>
std::vector<Target> targets_of(std::span<const Polygon> polygons, const dvec3& origin,
                               const Samples& samples) {
    std::vector<Target> targets;
    for (std::size_t polygon = 0; polygon < polygons.size(); ++polygon) {
        const Corners corners = seen_from(polygons[polygon], origin, samples.world_from_plane());
        const dvec3 normal = reference::normal({corners});
        const double height = -glm::dot(normal, corners[0]);
        if (height <= least_height(polygons[polygon])) continue;
        const int count = polygons[polygon].is_triangle() ? 3 : 4;
        dvec3 sum(0);
        for (int k = 0; k < count; ++k) sum += corners[k];
        Target target{int(polygon),           {}, 0, -normal / height, count / glm::length(sum),
                      samples.bounds(corners)};
        set_edges(target, corners);
        targets.push_back(target);
    }
    return targets;
}

// 1 / distance, or 0 where the sample misses.
double reciprocal_distance(const Target& target, const dvec3& direction, Distance distance) {
    for (int k = 0; k < target.edge_count; ++k)
        if (glm::dot(target.edges[k], direction) < 0) return 0;
    const double reciprocal = glm::dot(target.reciprocal, direction);
    if (reciprocal <= 0) return 0;
    return distance == Distance::along_ray ? reciprocal : target.of_patch;
}

template <class Samples>
std::vector<int> owners_of(std::span<const Polygon> polygons, const dvec3& origin,
                           const Samples& samples, Distance distance) {
    const glm::ivec2 size = samples.size();
    std::vector<int> owners(std::size_t(size.x) * size.y, kEscaped);
    std::vector<double> nearest(owners.size(), 0);
    for (const Target& target : targets_of(polygons, origin, samples)) {
        const auto& [columns, rows] = target.bounds;
        for (int row = rows.first; row <= rows.last; ++row) {
            for (int column = columns.first; column <= columns.last; ++column) {
                const double reciprocal =
                    reciprocal_distance(target, samples.direction(column, row), distance);
                const std::size_t at = std::size_t(row) * size.x + column;
                if (reciprocal <= nearest[at]) continue;
                nearest[at] = reciprocal;
                owners[at] = target.polygon;
            }
        }
    }
    return owners;
}

template <class Samples>
void add_factors(PointFactors& factors, std::span<const Polygon> polygons, const dvec3& origin,
                 const Samples& samples, Distance distance = Distance::along_ray) {
    const std::vector<int> owners = owners_of(polygons, origin, samples, distance);
    const glm::ivec2 size = samples.size();
    for (int row = 0; row < size.y; ++row) {
        for (int column = 0; column < size.x; ++column) {
            const double weight = samples.weight(column, row);
            const int owner = owners[std::size_t(row) * size.x + column];
            (owner == kEscaped ? factors.outside : factors.values[std::size_t(owner)]) += weight;
            factors.sample_count += weight > 0;
        }
    }
}

dmat3 axes_of(const Shooter& shooter) {
    return {shooter.u_axis, glm::cross(shooter.normal, shooter.u_axis), shooter.normal};
}

PointFactors none_yet(std::span<const Polygon> polygons) {
    return {std::vector<double>(polygons.size()), 0, 0};
}

}  // namespace

PointFactors hemisphere_factors(const Shooter& shooter, std::span<const Polygon> polygons,
                                int resolution, Distance distance) {
    PointFactors factors = none_yet(polygons);
    add_factors(factors, polygons, shooter.origin, Proxels(axes_of(shooter), resolution), distance);
    return factors;
}

PointFactors hemicube_factors(const Shooter& shooter, std::span<const Polygon> polygons,
                              int resolution) {
    PointFactors factors = none_yet(polygons);
    const dmat3 top = axes_of(shooter);
    const dvec3 normal = shooter.normal;
    const auto add = [&](const Pixels& face) {
        add_factors(factors, polygons, shooter.origin, face);
    };
    add({top, normal, {-1, -1}, {1, 1}, {resolution, resolution}});
    for (const dvec3& out : {top[0], top[1], -top[0], -top[1]})
        add({{glm::cross(normal, out), normal, out},
             normal,
             {-1, 0},
             {1, 1},
             {resolution, resolution / 2}});
    return factors;
}

PointFactors single_plane_factors(const Shooter& shooter, std::span<const Polygon> polygons,
                                  int resolution, double half_width) {
    PointFactors factors = none_yet(polygons);
    const dvec2 most(half_width);
    add_factors(factors, polygons, shooter.origin,
                Pixels(axes_of(shooter), shooter.normal, -most, most, {resolution, resolution}));
    return factors;
}

}  // namespace hemirad::reference
