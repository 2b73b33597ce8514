#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formfactor/convex.h"

namespace hemirad::formfactor {

/// What a point sees of a polygon past others: convex pieces, relative to the point. Keeps its
/// memory from point to point.
class VisiblePieces {
  public:
    void begin(std::span<const glm::dvec3> polygon, const glm::dvec3& eye);

    /// Takes away what lies within the cone of `blocker`, which turns its front to the eye and is
    /// nearer than the polygon. Whether anything was taken.
    bool hide_behind(std::span<const glm::dvec3> blocker);

    /// Sum of the pieces' factors.
    double factor(const glm::dvec3& normal) const;
    bool empty() const { return pieces_.ends.empty(); }

  private:
    struct Pieces {
        std::vector<glm::dvec3> corners;
        std::vector<std::size_t> ends;

        void clear();
        void add(std::span<const glm::dvec3> piece);
        std::span<const glm::dvec3> at(std::size_t index) const;
    };

    bool apart(std::span<const glm::dvec3> piece) const;
    bool cut(std::span<const glm::dvec3> piece);

    glm::dvec3 eye_{};
    std::vector<glm::dvec3> cone_;  ///< normals of planes through the eye, towards the inside
    Pieces pieces_, left_;
    std::vector<glm::dvec3> inside_, rest_, outside_;
};

}  // namespace hemirad::formfactor
