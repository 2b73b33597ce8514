#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "scene/contact.h"
#include "scene/mesh.h"
#include "scene/polygon.h"
#include "scene/precision.h"
#include "scene/split_polygon.h"

namespace hemirad::meshing {

/// By cell of a surface's grid, the contacts that run through it or along its sides.
class ContactGrid {
  public:
    ContactGrid() = default;
    ContactGrid(std::vector<Contact> contacts, const Surface& surface, double slack);

    std::vector<Contact> in(std::uint32_t cell) const;
    bool empty() const { return in_cells_.empty(); }

  private:
    std::vector<Contact> contacts_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> in_cells_;  ///< cell, contact; sorted
};

/// How near a contact may come to a line or a vertex and counts as on it: the precision, or what
/// would make a patch so slender that it is seen wrongly.
double contact_slack(const Surface& surface, const Precision& precision);

/// A convex polygon cut along the contacts, into strictly convex ones. None lies on both sides of a
/// contact by more than the slack, unless there are so many that the polygon stays whole.
std::vector<Polygon> cut_along_contacts(const Polygon& polygon,
                                        const std::vector<Contact>& contacts, double slack,
                                        const Precision& precision, PolygonSplitter& splitter);

}  // namespace hemirad::meshing
