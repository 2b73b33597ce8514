#pragma once

#include <cstdint>
#include <set>
#include <unordered_set>
#include <vector>

#include "scene/cut_contacts.h"
#include "scene/mesh.h"
#include "scene/polygon.h"

namespace hemirad::meshing {

/// A part of a cell on one side of every contact, and the patches that were made of it.
struct SidePiece {
    std::vector<std::uint32_t> corners;
    std::uint32_t first_patch, patch_count;
};

/// Where the pieces of a surface meet its contacts.
class ContactMarks {
  public:
    void add(const Polygon& piece, const std::vector<Contact>& contacts, double slack);

    bool empty() const { return vertices_.empty(); }
    bool is_on_contact(std::uint32_t vertex) const { return vertices_.contains(vertex); }
    bool runs_along_contact(std::uint32_t a, std::uint32_t b) const;

  private:
    std::unordered_set<std::uint32_t> vertices_;
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges_;
};

/// Surface::side_of_patch, for the pieces of all patches, in order. They hang together over
/// vertices off all contacts and over edges that run along none; what does not hang together and is
/// near has different sides.
std::vector<std::uint8_t> find_sides(const std::vector<SidePiece>& pieces, const Surface& surface,
                                     const ContactMarks& marks);

}  // namespace hemirad::meshing
