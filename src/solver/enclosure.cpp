#include "solver/enclosure.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace hemirad {
namespace {

// The rows of a rotation by an odd angle about an odd axis.
const glm::dvec3 kRay = glm::normalize(glm::dvec3(0.2718281828, 0.3141592653, 0.9093178221));
const glm::dvec3 kAcross =
    glm::normalize(glm::cross(kRay, glm::dvec3(0.7320508075, -0.4142135623, 0.2360679774)));
const glm::dvec3 kUpwards = glm::cross(kRay, kAcross);

glm::dvec3 turned(const glm::dvec3& p) {
    return {glm::dot(p, kAcross), glm::dot(p, kUpwards), glm::dot(p, kRay)};
}

// Whoever lists an edge, the same bits: a ray passes one of two neighbours.
bool passes_left_of(const glm::dvec2& at, glm::dvec2 a, glm::dvec2 b) {
    if ((a.y > at.y) == (b.y > at.y)) return false;
    if (a.y > b.y) std::swap(a, b);
    return at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x);
}

}  // namespace

Enclosure::Enclosure(const Mesh& mesh, const MergedVertices& vertices,
                     std::span<const std::uint32_t> sides) {
    double last_x = -std::numeric_limits<double>::infinity();
    first_x_ = -last_x;
    for (const std::uint32_t side : sides) {
        const Patch& patch = mesh.patches[side / 2];
        const glm::dvec3 normal = turned(mesh.normal(patch));
        Outline outline{};
        outline.low_y = std::numeric_limits<double>::infinity();
        outline.high_y = -outline.low_y;
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::dvec3 at = turned(vertices.positions[vertices.of[patch.corners[k]]]);
            outline.corners[k] = {at.x, at.y};
            outline.low_y = std::min(outline.low_y, at.y);
            outline.high_y = std::max(outline.high_y, at.y);
            first_x_ = std::min(first_x_, at.x);
            last_x = std::max(last_x, at.x);
            if (k == 0) outline.base = glm::dot(normal, at) / normal.z;
        }
        outline.slope_x = -normal.x / normal.z;
        outline.slope_y = -normal.y / normal.z;
        outline.leaves = (normal.z < 0) == (side % 2 == 0) ? 1 : -1;
        if (normal.z != 0) outlines_.push_back(outline);
    }
    slices_.resize(1 + static_cast<std::size_t>(std::sqrt(double(outlines_.size()))));
    slice_width_ = (last_x - first_x_) / static_cast<double>(slices_.size());
    for (std::uint32_t i = 0; i < outlines_.size(); ++i) {
        const auto [low, high] = std::ranges::minmax(outlines_[i].corners, {}, &glm::dvec2::x);
        for (std::size_t slice = slice_of(low.x); slice <= slice_of(high.x); ++slice)
            slices_[slice].push_back(i);
    }
}

std::size_t Enclosure::slice_of(double x) const {
    const double slice = (x - first_x_) / slice_width_;
    const double last = static_cast<double>(slices_.size() - 1);
    return slice > 0 ? static_cast<std::size_t>(std::min(slice, last)) : 0;
}

bool Enclosure::holds(const glm::dvec3& point) const {
    const glm::dvec3 at = turned(point);
    const auto& slice = slices_[slice_of(at.x)];
    looks_ += slice.size();
    int leaves = 0;
    for (const std::uint32_t i : slice) {
        const Outline& outline = outlines_[i];
        if (at.y < outline.low_y || at.y > outline.high_y) continue;
        if (outline.slope_x * at.x + outline.slope_y * at.y + outline.base <= at.z) continue;
        bool inside = false;
        for (std::size_t k = 0; k < 4; ++k)
            inside ^=
                passes_left_of({at.x, at.y}, outline.corners[k], outline.corners[(k + 1) % 4]);
        if (inside) leaves += outline.leaves;
    }
    return leaves > 0;
}

}  // namespace hemirad
