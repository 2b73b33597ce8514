#include "solver/contacts.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "formfactor/convex.h"

namespace hemirad {
namespace {

constexpr double kFlat = 1e-9;  // of the size of a pair: the mesher's welding leaves less

bool lie_on_each_other(const PatchShape& a, const PatchShape& b) {
    const double reach = a.radius + b.radius;
    const glm::dvec3 gap = b.centre - a.centre;
    if (std::abs(glm::dot(a.normal, gap)) > kFlat * reach) return false;
    if (glm::dot(gap, gap) > reach * reach) return false;
    return std::ranges::all_of(b.corners, [&](const glm::dvec3& corner) {
        return std::abs(glm::dot(a.normal, corner - a.centre)) < kFlat * reach;
    });
}

double common_area(const PatchShape& a, const PatchShape& b) {
    ConvexPolygon common = a.corners;
    for (std::size_t k = 0; k < b.corners.size() && common.size() >= 3; ++k) {
        const glm::dvec3 edge = b.corners[(k + 1) % b.corners.size()] - b.corners[k];
        const glm::dvec3 inwards = glm::normalize(glm::cross(b.normal, edge));
        common = formfactor::in_front({inwards, glm::dot(inwards, b.corners[k])}, common,
                                      kFlat * b.radius);
    }
    return common.size() < 3 ? 0 : 0.5 * glm::length(formfactor::vector_area(common));
}

}  // namespace

std::vector<Contact> contacts(const Mesh& mesh, const std::vector<PatchShape>& patches) {
    const auto surface = [&](std::uint32_t patch) -> const Surface& {
        return mesh.surfaces[mesh.patches[patch].surface];
    };
    std::vector<Contact> found;
    for (std::uint32_t i = 0; i < patches.size(); ++i)
        for (std::uint32_t j = i + 1; j < patches.size(); ++j) {
            if (glm::dot(patches[i].normal, patches[j].normal) > kFlat - 1) continue;
            if (!lie_on_each_other(patches[i], patches[j])) continue;
            if (surface(i).object == surface(j).object || surface(i).is_back || surface(j).is_back)
                continue;
            const double area = common_area(patches[i], patches[j]);
            if (area > kFlat * std::min(patches[i].area, patches[j].area))
                found.push_back({i, j, area});
        }
    return found;
}

}  // namespace hemirad
