#pragma once

#include <span>
#include <vector>

#include "scene/contact.h"
#include "scene/edges.h"
#include "scene/flat_faces.h"
#include "scene/group_flats.h"
#include "scene/mesh.h"
#include "scene/precision.h"
#include "scene/segment_tree.h"

namespace hemirad::meshing {

enum class Sides { front, both };

/// Finds the edges of other surfaces that lie on one.
class ContactFinder {
  public:
    /// What is given, `edges` sorted, must outlive the finder.
    ContactFinder(const FlatFaces& faces, std::span<const Edge> edges,
                  const std::vector<Group>& groups, const std::vector<glm::dvec3>& vertices,
                  const Precision& precision);

    /// Edges in the surface's plane, to Precision::plane, of outlines of what reaches in front of
    /// that plane or lies in it; with Sides::both, of what reaches behind it, too. Not the
    /// surface's own outline.
    std::vector<Contact> on(std::uint32_t group, const Surface& surface, Sides sides);

    /// Edges in the surface's plane of outlines of what stands up from it, on its own outline, too;
    /// none once there were too many.
    std::vector<Wall> walls_on(std::uint32_t group, const Surface& surface, Sides sides);

    bool complete() const { return looks_left_ > 0; }  ///< else there were too many to find all

  private:
    using Shared = std::span<const Edge>;

    /// Above the surface's plane; 0 where none is.
    struct Heights {
        double low = 0, high = 0;
    };

    Heights heights(std::uint32_t flat, const Surface& surface) const;
    bool ends_on(Shared edge, std::uint32_t group, const Surface& surface, Sides sides) const;
    bool reaches(std::uint32_t flat, const Surface& surface, Sides sides) const;
    bool stands_up(std::uint32_t flat, const Surface& surface, Sides sides) const;

    const FlatFaces& faces_;
    const std::vector<glm::dvec3>& vertices_;
    double precision_;
    std::vector<std::uint32_t> group_of_flat_;
    std::vector<Shared> outlines_;  ///< edges of surfaces' outlines, with all who share them
    SegmentTree tree_;              ///< of these
    double looks_left_, wall_looks_left_;
};

}  // namespace hemirad::meshing
