#include "reference/projector.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>

// What a proxel sees, and what it might see
// ----------------------------------------
// A ray leaves the origin O along the unit direction x. An edge from p to q, both relative to O,
// has
//     m = dot(cross(q, p), x) / |q - p|,
// the distance between ray and edge line times the sine of their angle. Seen from its front a
// polygon is counter-clockwise, and the ray meets it where m >= 0 at every edge. Swapping p and q
// flips the sign of m exactly, so two polygons that share an edge never both miss a ray between
// them.
//
// Now let each point of a polygon move by up to d, the bound at its farthest corner and so no less
// than at any other point of it. A displaced polygon meets the ray at a point that came from some y
// of the polygon within d of the ray. With h the height of O above the polygon's plane and
// c = -dot(normal, x):
//  (1) y is at a distance t along the ray, to within d, so |h - c t| <= d and
//      min |y| - d <= t <= max |y| + d: the range of depths.
//  (2) y satisfies dot(cross(q, p), y) / |q - p| >= 0, and this is a moment that d changes by no
//      more than d |O to edge line|. With y = t x to within d: m >= -d |O to edge line| / t.
//  (3) The signed count of intersections of ray and polygon changes only where the polygon's
//      boundary comes across the ray or the polygon across O. With m > d at every edge the former
//      does not happen, as |m| is at most the distance from ray to edge; with h > d neither does
//      the latter. The hit is then sure, whatever the displacement, and no farther than the range
//      of (1).
//  (4) The moments themselves may err by d', the bound at the edge's nearer end, as floats do, or
//      edges be moved outwards by it. Of an edge that points at O, d' moves the line by more than
//      d', by d' over the sine of their angle; so with -d' <= m < 0 the ray may hit the plane
//      beyond the polygon, and the range of depths is the plane's, too. Off its ends a line also
//      turns: m = dot(cross(q, p), x) / |q - p| changes by up to d (|cross(p, x)| + |cross(q, x)|)
//      / |q - p|, which is d between the ends.
// A polygon is admissible if (1) and (2) hold, or (4), and no sure hit lies before its range. Each
// polygon has its own d; they meet only in their ranges, which hold that d.
//
// Displaced vertices turn a normal by up to 2 d / width: one up, the opposite edge down; by no more
// than `turn` where the normal does not come from them. The plane at O then moves by up to
// d + tilt * max |y|, and where |h| is less the polygon is edge-on: it may show either side, (2)
// says nothing of its back, and no hit is sure. Lower, it shows its back only. No front is seen
// along a ray that follows the normal, c <= -tilt: this is why a shooter cannot see its own patch,
// nor any other of its plane.
//
// This file's own doubles, u = 2^-53 and r the farthest point: a corner less the origin errs by
// u |component| each, sqrt(3) u r in all where both lie on one grid or the origin is 0; its moment,
// from q - p and the lesser of p and q, by 4 u r; the product with x, itself within 2 u of its
// direction, by 5 u r more. In all below 12 u r < kProjectorRounding r.
namespace hemirad::reference {
namespace {

using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kOwnRounding = 1e-12;  // of columns, rows and radii, generously

struct Range {
    double low, high;
};

struct Edge {
    dvec3 moment;     // cross(q, p) / |q - p|
    double distance;  // from the origin to the edge's line
    dvec3 from, to;
    double length;
    double bound;  // d' above
};

// A polygon as the origin knows it.
struct Target {
    int polygon = 0;
    dvec3 normal{};
    double height = 0;  // of the origin above the polygon's plane
    bool edge_on = false;
    double bound = 0;  // d above
    double tilt = 0;
    Range distance{};  // of the polygon's points from the origin, widened by the bound
    std::array<Edge, 4> edges{};
    int edge_count = 0;
    int first_column = 0, last_column = -1, first_row = 0, last_row = -1;
};

// A polygon that a ray meets, or may meet.
struct Sighting {
    bool hit, sure;
    double distance;  // of the hit
    Range range;
};

struct Candidate {
    int polygon;
    double nearest;
};

struct Proxel {
    int owner = kEscaped;
    double distance = kInfinity;     // of the owner
    double sure_before = kInfinity;  // some sure hit is no farther than this
    std::vector<Candidate> candidates;
};

double centre(int index, int resolution) { return double(2 * index + 1 - resolution) / resolution; }

// Of the corners over the edges: what a vertex can move up while the others move down.
double least_width(const std::array<dvec3, 4>& corners) {
    double width = kInfinity;
    for (std::size_t k = 0; k < 4; ++k) {
        const dvec3 along = corners[(k + 1) % 4] - corners[k];
        const double length = glm::length(along);
        if (length == 0) continue;
        double height = 0;
        for (const dvec3& corner : corners)
            height = std::max(height, glm::length(glm::cross(along, corner - corners[k])) / length);
        width = std::min(width, height);
    }
    return width;
}

bool precedes(const dvec3& p, const dvec3& q) {
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
}

// cross(q, p), from their difference: two long products of nearly equal corners would cancel.
dvec3 moment_of(const dvec3& p, const dvec3& q) {
    return precedes(p, q) ? glm::cross(q - p, p) : -glm::cross(p - q, q);
}

void set_edges(Target& target, const std::array<dvec3, 4>& corners, const Bound& bound) {
    for (std::size_t k = 0; k < 4; ++k) {
        const dvec3 p = corners[k];
        const dvec3 q = corners[(k + 1) % 4];
        const double length = glm::length(q - p);
        if (length == 0) continue;
        const dvec3 moment = moment_of(p, q) / length;
        const double nearer = std::min(glm::length(p), glm::length(q));
        target.edges[target.edge_count++] = {
            moment, glm::length(moment), p, q, length, bound.relative * nearer + bound.absolute};
    }
}

// All directions within `half_angle` of `towards` have a component along `axis` in this range.
Range component_range(const dvec3& towards, double half_angle, const dvec3& axis) {
    const double angle = std::acos(std::clamp(glm::dot(towards, axis), -1.0, 1.0));
    return {std::cos(std::min(std::numbers::pi, angle + half_angle)),
            std::cos(std::max(0.0, angle - half_angle))};
}

int proxel_below(double coordinate, int resolution) {
    const double index = std::floor((coordinate * resolution + resolution - 1) / 2 - kOwnRounding);
    return std::clamp(int(index), 0, resolution - 1);
}

int proxel_above(double coordinate, int resolution) {
    const double index = std::ceil((coordinate * resolution + resolution - 1) / 2 + kOwnRounding);
    return std::clamp(int(index), 0, resolution - 1);
}

// The polygon lies in a ball, the ball in a cone of directions. `distance` keeps clear of the ball.
void set_bounds(Target& target, const std::array<dvec3, 4>& corners, const Shooter& shooter,
                int resolution) {
    const dvec3 middle = (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0;
    double radius = 0;
    for (const dvec3& corner : corners) radius = std::max(radius, glm::distance(corner, middle));
    radius = (radius + target.bound) * (1 + kOwnRounding);
    const double away = glm::length(middle);
    target.distance = {std::max(0.0, away - radius), away + radius};
    // Moments that err by d reach out of the cone, where the ball is as near as a thousand d.
    const bool around = away - radius <= 1e3 * target.bound;
    const dvec3 towards = around ? shooter.normal : middle / away;
    const double half_angle = around ? std::numbers::pi : std::asin(radius / away) + 1e-7;
    if (component_range(towards, half_angle, shooter.normal).high <= 0) return;
    const Range u = component_range(towards, half_angle, shooter.u_axis);
    const Range v =
        component_range(towards, half_angle, glm::cross(shooter.normal, shooter.u_axis));
    target.first_column = proxel_below(u.low, resolution);
    target.last_column = proxel_above(u.high, resolution);
    target.first_row = proxel_below(v.low, resolution);
    target.last_row = proxel_above(v.high, resolution);
}

double farthest(const std::array<dvec3, 4>& corners) {
    double distance = 0;
    for (const dvec3& corner : corners) distance = std::max(distance, glm::length(corner));
    return distance;
}

std::optional<Target> target_of(const Polygon& polygon, const Shooter& shooter, int resolution,
                                const Bound& bound) {
    Target target;
    target.normal = normal(polygon);
    if (target.normal == dvec3(0)) return std::nullopt;
    std::array<dvec3, 4> corners = polygon.corners;
    for (dvec3& corner : corners) corner -= shooter.origin;
    target.bound = bound.relative * farthest(corners) + bound.absolute;
    set_bounds(target, corners, shooter, resolution);
    set_edges(target, corners, bound);
    target.height = -glm::dot(target.normal, corners[0]);
    target.tilt = std::min(2 * target.bound / least_width(corners), bound.turn);
    const double play = target.bound + target.tilt * target.distance.high;
    if (target.height < -play) return std::nullopt;
    target.edge_on = target.height <= play;
    return target;
}

std::vector<Target> targets_of(std::span<const Polygon> polygons, const Shooter& shooter,
                               int resolution, const Bound& bound) {
    std::vector<Target> targets;
    for (std::size_t polygon = 0; polygon < polygons.size(); ++polygon) {
        auto target = target_of(polygons[polygon], shooter, resolution, bound);
        if (!target) continue;
        target->polygon = int(polygon);
        targets.push_back(*target);
    }
    return targets;
}

// (1) above. Empty, low > high, where no displacement brings the polygon's plane to the ray.
Range depth_range(const Target& target, double cosine) {
    const double bound = target.bound;
    Range slab{-kInfinity, kInfinity};
    if (cosine != 0) {
        const double a = (target.height - bound) / cosine;
        const double b = (target.height + bound) / cosine;
        slab = {std::min(a, b), std::max(a, b)};
    } else if (std::abs(target.height) > bound) {
        slab = {kInfinity, -kInfinity};
    }
    return {std::max(slab.low, target.distance.low), std::min(slab.high, target.distance.high)};
}

// (4) above: the moment's change where the ends move by 1.
double turned_by(const Edge& edge, const dvec3& direction) {
    return (glm::length(glm::cross(edge.from, direction)) +
            glm::length(glm::cross(edge.to, direction))) /
           edge.length;
}

// (4) above: of the plane, displaced by the bound and turned by the tilt.
Range plane_range(const Target& target, double cosine) {
    const double steepest = cosine + target.tilt, flattest = cosine - target.tilt;
    return {std::max(0.0, (target.height - target.bound) / steepest),
            flattest > 0 ? (target.height + target.bound) / flattest : kInfinity};
}

std::optional<Sighting> sight(const Target& target, const dvec3& direction) {
    const double cosine = -glm::dot(target.normal, direction);
    if (cosine <= -target.tilt) return std::nullopt;
    Range range = depth_range(target, cosine);
    bool displaced = range.low <= range.high, outlined = true;
    double least = kInfinity;
    for (int k = 0; k < target.edge_count; ++k) {
        const Edge& edge = target.edges[k];
        const double moment = glm::dot(edge.moment, direction);
        displaced = displaced &&
                    (target.edge_on || moment >= -target.bound * edge.distance / range.low);  // (2)
        outlined = outlined && (moment >= -edge.bound ||
                                moment >= -target.bound * turned_by(edge, direction));  // (4)
        least = std::min(least, moment);
    }
    if (!displaced && !outlined) return std::nullopt;
    if (outlined && least < 0) {
        const Range beyond = plane_range(target, cosine);
        range = displaced
                    ? Range{std::min(range.low, beyond.low), std::max(range.high, beyond.high)}
                    : beyond;
    }
    const bool hit = target.height > 0 && cosine > 0 && least >= 0;
    const bool sure = hit && !target.edge_on && least > target.bound;  // (3)
    return Sighting{hit, sure, target.height / cosine, range};
}

void record(Proxel& proxel, int polygon, const Sighting& sighting) {
    if (sighting.hit && sighting.distance < proxel.distance) {
        proxel.distance = sighting.distance;
        proxel.owner = polygon;
    }
    if (sighting.sure) proxel.sure_before = std::min(proxel.sure_before, sighting.range.high);
    if (sighting.range.low <= proxel.sure_before)
        proxel.candidates.push_back({polygon, sighting.range.low});
}

std::vector<int> admissible(const Proxel& proxel) {
    std::vector<int> owners;
    if (proxel.sure_before == kInfinity) owners.push_back(kEscaped);
    for (const Candidate& candidate : proxel.candidates)
        if (candidate.nearest <= proxel.sure_before) owners.push_back(candidate.polygon);
    return owners;
}

std::vector<dvec3> row_directions(const Shooter& shooter, int row, int resolution) {
    const dvec3 v_axis = glm::cross(shooter.normal, shooter.u_axis);
    const double v = centre(row, resolution);
    std::vector<dvec3> directions;
    for (int column = 0; column < resolution; ++column) {
        const double u = centre(column, resolution);
        const double w = std::sqrt(std::max(0.0, 1 - u * u - v * v));
        directions.push_back(u * shooter.u_axis + v * v_axis + w * shooter.normal);
    }
    return directions;
}

std::vector<Proxel> project_row(std::span<const Target> targets, const Shooter& shooter, int row,
                                int resolution) {
    const std::vector<dvec3> directions = row_directions(shooter, row, resolution);
    std::vector<Proxel> proxels(directions.size());
    for (const Target& target : targets) {
        if (row < target.first_row || row > target.last_row) continue;
        for (int column = target.first_column; column <= target.last_column; ++column) {
            if (!in_disk(column, row, resolution)) continue;
            const auto sighting = sight(target, directions[column]);
            if (sighting) record(proxels[column], target.polygon, *sighting);
        }
    }
    return proxels;
}

}  // namespace

// In integers, as the centres are odd or even multiples of 1/N. None lies on the rim: u and v have
// the parity of N - 1, and two odd squares are 2 modulo 4, two even ones no odd square.
bool in_disk(int column, int row, int resolution) {
    const std::int64_t n = resolution;
    const std::int64_t u = 2 * std::int64_t(column) + 1 - n;
    const std::int64_t v = 2 * std::int64_t(row) + 1 - n;
    return u * u + v * v < n * n;
}

std::uint64_t disk_proxel_count(int resolution) {
    std::uint64_t inside = 0;
    for (int row = 0; row < resolution; ++row)
        for (int column = 0; column < resolution; ++column)
            inside += in_disk(column, row, resolution);
    return inside;
}

bool Truth::admits(std::size_t proxel, int candidate) const {
    const auto found = undecided.find(proxel);
    if (found == undecided.end()) return owner[proxel] == candidate;
    return std::ranges::binary_search(found->second, candidate);
}

std::uint64_t Truth::count(int candidate) const {
    return std::uint64_t(std::ranges::count(owner, candidate));
}

Truth project(const Shooter& shooter, std::span<const Polygon> polygons, int resolution,
              const Bound& bound) {
    const std::vector<Target> targets = targets_of(polygons, shooter, resolution, bound);
    Truth truth;
    truth.resolution = resolution;
    truth.owner.assign(std::size_t(resolution) * resolution, kOutsideDisk);
    for (int row = 0; row < resolution; ++row) {
        const auto proxels = project_row(targets, shooter, row, resolution);
        for (int column = 0; column < resolution; ++column) {
            if (!in_disk(column, row, resolution)) continue;
            const std::size_t proxel = std::size_t(row) * resolution + column;
            truth.owner[proxel] = proxels[column].owner;
            auto owners = admissible(proxels[column]);
            if (owners.size() > 1) truth.undecided.emplace(proxel, std::move(owners));
        }
    }
    return truth;
}

}  // namespace hemirad::reference
