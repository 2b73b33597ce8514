#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace hemirad {

/// What cannot see each other for topology's sake, whatever a hemisphere resolves (the cells of
/// Airey, Rohlf and Brooks 1990, as far as no light at all passes between them).
struct Rooms {
    /// [patch] A bit: the room that it looks into. There are 32; what is beyond shares the last.
    std::vector<std::uint32_t> before;
    /// [patch] The rooms that light from its front may come to: its own, and through the backs of
    /// patches, which let light pass, others; kAllRooms where these are all there are.
    std::vector<std::uint32_t> reached;
};

inline constexpr std::uint32_t kAllRooms = 0xffffffffu;

/// Rooms are what closed surfaces of patches bound, edge by edge, and what floats within. What
/// penetrates one without an edge joins it with what is on the other side; where patches do not
/// meet to the weld, the two sides of that wall are one room. Empty where there is but one room, in
/// meshes made by hand, and where finding them would take too long.
Rooms find_rooms(const Mesh& mesh);

}  // namespace hemirad
