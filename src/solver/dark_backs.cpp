#include "solver/dark_backs.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "solver/find_rooms.h"

namespace hemirad {
namespace {

bool emits(const Mesh& mesh, const Patch& patch) {
    const auto& emission = mesh.materials[mesh.surfaces[patch.surface].material].emission;
    return std::ranges::any_of(emission, [](double radiance) { return radiance > 0; });
}

/// Rooms that light comes to, from lamps or from what reflects it.
std::uint32_t lit_rooms(const Mesh& mesh, const Rooms& rooms) {
    std::uint32_t lit = 0;
    for (std::size_t i = 0; i < mesh.patches.size(); ++i)
        if (emits(mesh, mesh.patches[i])) lit |= rooms.reached[i];
    for (std::uint32_t before = 0; before != lit;) {
        before = lit;
        for (std::size_t i = 0; i < mesh.patches.size(); ++i)
            if ((rooms.before[i] & lit) != 0) lit |= rooms.reached[i];
    }
    return lit;
}

}  // namespace

void drop_dark_backs(Mesh& mesh) {
    const Rooms rooms = find_rooms(mesh);
    if (rooms.before.empty()) return;
    const std::uint32_t lit = lit_rooms(mesh, rooms);
    for (Surface& surface : mesh.surfaces) {
        if (!surface.is_back || !surface.has_chart) continue;
        const auto first = rooms.before.begin() + surface.first_patch;
        surface.has_chart = std::any_of(first, first + surface.patch_count,
                                        [&](std::uint32_t room) { return (room & lit) != 0; });
    }
}

}  // namespace hemirad
