#include "scene/contact.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace hemirad::meshing {
namespace {

// Twice the slack, so that rounding loses none.
bool reaches_line_of(const Contact& contact, const Polygon& polygon, double slack) {
    const glm::dvec2 along = contact.to - contact.from, across(-along.y, along.x);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Corner& corner : polygon) {
        const double beyond = glm::dot(across, corner.at - contact.from);
        low = std::min(low, beyond);
        high = std::max(high, beyond);
    }
    const double most = 2 * slack * glm::length(along);
    return low <= most && high >= -most;
}

}  // namespace

double distance(const Contact& contact, const glm::dvec2& at) {
    const glm::dvec2 along = contact.to - contact.from;
    const double square = glm::dot(along, along);
    const double t = square > 0 ? glm::dot(at - contact.from, along) / square : 0;
    return glm::distance(at, contact.from + std::clamp(t, 0.0, 1.0) * along);
}

bool runs_along(const Contact& contact, const glm::dvec2& a, const glm::dvec2& b, double slack) {
    const double length = glm::distance(a, b);
    if (length <= slack) return false;
    const glm::dvec2 along = (b - a) / length, across(-along.y, along.x);
    glm::dvec2 from(glm::dot(contact.from - a, along), glm::dot(contact.from - a, across));
    glm::dvec2 to(glm::dot(contact.to - a, along), glm::dot(contact.to - a, across));
    if (from.x > to.x) std::swap(from, to);
    const double begin = std::max(0.0, from.x), end = std::min(length, to.x);
    if (end - begin <= slack) return false;
    const auto height = [&](double t) {
        return std::abs(from.y + (to.y - from.y) * (t - from.x) / (to.x - from.x));
    };
    return height(begin) <= slack && height(end) <= slack;
}

std::vector<Contact> about(const Polygon& polygon, std::span<const Contact> contacts,
                           double slack) {
    std::vector<Contact> near;
    std::ranges::copy_if(contacts, std::back_inserter(near), [&](const Contact& contact) {
        return reaches_line_of(contact, polygon, slack);
    });
    return near;
}

}  // namespace hemirad::meshing
