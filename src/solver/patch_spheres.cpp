#include "solver/patch_spheres.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>

namespace hemirad {
namespace {

constexpr std::size_t kGroup = 8;

double height(const PatchShape& plane, const PatchShape& sphere) {
    return glm::dot(plane.normal, sphere.centre - plane.centre);
}

// Turns its front to a part of `a`, has a part of `b` behind it, and reaches in front of both.
bool may_hide(const PatchShape& patch, const PatchShape& a, const PatchShape& b) {
    return height(patch, a) > -a.radius && height(patch, b) < b.radius &&
           height(a, patch) > -patch.radius && height(b, patch) > -patch.radius;
}

// Around the bounding spheres of two patches.
class Capsule {
  public:
    Capsule(const PatchShape& a, const PatchShape& b)
        : start_(a.centre), along_(b.centre - a.centre), radius_(std::max(a.radius, b.radius)) {
        const double squared = glm::dot(along_, along_);
        inverse_ = squared > 0 ? 1 / squared : 0;
    }

    const glm::dvec3& start() const { return start_; }
    const glm::dvec3& along() const { return along_; }
    double radius() const { return radius_; }
    double inverse() const { return inverse_; }

    bool touches(const Sphere& sphere) const {
        const glm::dvec3 gap = sphere.centre - start_;
        const double t = std::clamp(glm::dot(gap, along_) * inverse_, 0.0, 1.0);
        const glm::dvec3 across = gap - t * along_;
        const double reach = radius_ + sphere.radius;
        return glm::dot(across, across) <= reach * reach;
    }

  private:
    glm::dvec3 start_, along_;
    double radius_, inverse_;
};

struct FloatCapsule {
    float x, y, z, along_x, along_y, along_z, inverse, radius;
};

FloatCapsule in_floats(const Capsule& capsule) {
    const glm::vec3 start(capsule.start()), along(capsule.along());
    return {start.x,
            start.y,
            start.z,
            along.x,
            along.y,
            along.z,
            float(capsule.inverse()),
            float(capsule.radius())};
}

// What chooses a clone runs before ThreadSanitizer is there, which GCC 12 has it call.
#ifdef __SANITIZE_THREAD__
#define HEMI_CLONES
#else
#define HEMI_CLONES [[gnu::target_clones("avx512f", "avx2", "default")]]
#endif

// 1 for each sphere that a capsule touches; for any processor, as fast as this one can.
HEMI_CLONES void mark_touched(const FloatCapsule& c, std::size_t count, const float* x,
                              const float* y, const float* z, const float* radius,
                              std::uint8_t* touched) {
    for (std::size_t i = 0; i < count; ++i) {
        const float gx = x[i] - c.x, gy = y[i] - c.y, gz = z[i] - c.z;
        float t = (gx * c.along_x + gy * c.along_y + gz * c.along_z) * c.inverse;
        t = t < 0.0f ? 0.0f : t;
        t = t > 1.0f ? 1.0f : t;
        const float ax = gx - t * c.along_x, ay = gy - t * c.along_y, az = gz - t * c.along_z;
        const float reach = c.radius + radius[i];
        touched[i] = ax * ax + ay * ay + az * az <= reach * reach;
    }
}

// Halves the longest side of the patches' extent until groups are left.
void sort_in_space(const std::vector<PatchShape>& patches, std::span<std::uint32_t> order) {
    if (order.size() <= kGroup) return;
    glm::dvec3 least = patches[order[0]].centre, most = least;
    for (const std::uint32_t patch : order) {
        least = glm::min(least, patches[patch].centre);
        most = glm::max(most, patches[patch].centre);
    }
    const glm::dvec3 size = most - least;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = (order.size() / 2 + kGroup - 1) / kGroup * kGroup;
    const auto middle = order.begin() + std::ptrdiff_t(half);
    std::nth_element(order.begin(), middle, order.end(), [&](std::uint32_t i, std::uint32_t j) {
        const double a = patches[i].centre[axis], b = patches[j].centre[axis];
        return a != b ? a < b : i < j;
    });
    sort_in_space(patches, order.first(half));
    sort_in_space(patches, order.subspan(half));
}

std::vector<std::uint32_t> near_neighbours(const std::vector<PatchShape>& patches) {
    std::vector<std::uint32_t> order(patches.size());
    std::iota(order.begin(), order.end(), 0u);
    sort_in_space(patches, order);
    return order;
}

Sphere around(std::span<const Sphere> group) {
    glm::dvec3 sum(0);
    for (const Sphere& member : group) sum += member.centre;
    Sphere sphere{sum / double(group.size()), 0};
    for (const Sphere& member : group)
        sphere.radius =
            std::max(sphere.radius, glm::distance(member.centre, sphere.centre) + member.radius);
    return sphere;
}

double largest_coordinate(std::span<const Sphere> spheres) {
    double largest = 0;
    for (const Sphere& sphere : spheres) {
        const glm::dvec3 far = glm::abs(sphere.centre) + sphere.radius;
        largest = std::max({largest, far.x, far.y, far.z});
    }
    return largest;
}

}  // namespace

PatchSpheres::PatchSpheres(const std::vector<PatchShape>& patches)
    : patches_(patches), order_(near_neighbours(patches)) {
    for (const std::uint32_t patch : order_)
        spheres_.push_back({patches[patch].centre, patches[patch].radius});
    // A dozen roundings of floats as large as the largest coordinate.
    const double rounding = 12 * 0x1p-24 * largest_coordinate(spheres_);
    for (std::size_t begin = 0; begin < spheres_.size(); begin += kGroup) {
        const Sphere group =
            around(std::span(spheres_).subspan(begin, std::min(kGroup, spheres_.size() - begin)));
        group_x_.push_back(float(group.centre.x));
        group_y_.push_back(float(group.centre.y));
        group_z_.push_back(float(group.centre.z));
        group_radius_.push_back(float(group.radius + rounding));
    }
}

void PatchSpheres::between(std::uint32_t from, std::uint32_t to,
                           std::vector<ConvexPolygon>& blockers) {
    blockers.clear();
    const PatchShape &a = patches_[from], &b = patches_[to];
    const Capsule capsule(a, b);
    touched_.resize(group_x_.size());
    mark_touched(in_floats(capsule), touched_.size(), group_x_.data(), group_y_.data(),
                 group_z_.data(), group_radius_.data(), touched_.data());
    for (std::size_t group = 0; group < touched_.size(); ++group) {
        if (touched_[group] == 0) continue;
        const std::size_t end = std::min(order_.size(), (group + 1) * kGroup);
        for (std::size_t at = group * kGroup; at < end; ++at) {
            if (!capsule.touches(spheres_[at])) continue;
            const std::uint32_t patch = order_[at];
            if (patch != from && patch != to && may_hide(patches_[patch], a, b))
                blockers.push_back(patches_[patch].corners);
        }
    }
}

}  // namespace hemirad
