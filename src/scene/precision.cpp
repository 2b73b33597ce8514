#include "scene/precision.h"

#include <algorithm>
#include <cmath>

namespace hemirad::meshing {

Precision precision_of(const std::vector<glm::dvec3>& positions) {
    constexpr double kFloatUlp = 0x1p-23;
    double largest = 0;
    for (const auto& p : positions)
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    const double weld = 4 * kFloatUlp * largest;
    return {weld, 2 * weld};
}

}  // namespace hemirad::meshing
