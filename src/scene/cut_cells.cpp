#include "scene/cut_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/split_polygon.h"

namespace hemirad::meshing {
namespace {

/// Where a line cuts an edge the vertex may be drawn to one that is near, as welding does; what is
/// cut next is the edge that was there, or a narrow face would be drawn further onto it line by
/// line.
struct CutCorner : Corner {
    glm::dvec3 place;  ///< not drawn to any other vertex; `at` is that in the plane
};

using CutOutline = std::vector<CutCorner>;

class CellCutter {
  public:
    CellCutter(const Surface& surface, double precision, VertexWelder& vertices)
        : surface_(surface),
          precision_(precision),
          frame_{surface.origin, surface.u_axis, surface.v_axis, surface.normal},
          vertices_(vertices) {}

    void cut(std::uint32_t face, std::span<const std::uint32_t> piece) {
        CutOutline outline;
        for (const std::uint32_t v : piece) outline.push_back(corner(v, vertices_[v]));
        cut(face, std::move(outline));
    }

    void cut(std::uint32_t face, const Polygon& polygon) {
        CutOutline outline;
        for (const Corner& c : polygon) outline.push_back({c, vertices_[c.vertex]});
        cut(face, std::move(outline));
    }

    std::vector<CellPiece> take() {
        std::ranges::stable_sort(pieces_, {}, &CellPiece::cell);
        return std::move(pieces_);
    }

  private:
    void cut(std::uint32_t face, CutOutline outline) {
        slice(std::move(outline), 0, surface_.columns, [&](CutOutline strip, std::uint32_t column) {
            slice(std::move(strip), 1, surface_.rows,
                  [&](const CutOutline& cell, std::uint32_t row) {
                      add(row * surface_.columns + column, face, cell);
                  });
        });
    }

    void add(std::uint32_t cell, std::uint32_t face, const CutOutline& outline) {
        Polygon polygon;
        for (const CutCorner& c : outline)
            polygon.push_back({c.vertex, frame_.project(vertices_[c.vertex])});
        remove_repeats(polygon);
        if (!polygon.empty()) pieces_.push_back({cell, face, std::move(polygon)});
    }

    CutCorner corner(std::uint32_t vertex, const glm::dvec3& place) const {
        return {{vertex, frame_.project(place)}, place};
    }

    // Cuts along the lines across one axis, lowest first, and hands each slice to `keep`.
    template <class Keep>
    void slice(CutOutline rest, int axis, std::uint32_t count, Keep keep) {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (const Corner& c : rest) {
            low = std::min(low, c.at[axis]);
            high = std::max(high, c.at[axis]);
        }
        const double size = surface_.cell_size[axis];
        const double first = std::floor((low + precision_) / size);
        auto index = static_cast<std::uint32_t>(std::clamp(first, 0.0, count - 1.0));
        for (; index + 1 < count && (index + 1) * size < high - precision_; ++index) {
            const Line line{axis == 0 ? glm::dvec2(1, 0) : glm::dvec2(0, 1), (index + 1) * size};
            auto [below, above] =
                split(rest, line, precision_,
                      [&](const CutCorner& a, const CutCorner& b, double fraction) {
                          const glm::dvec3 place = a.place + fraction * (b.place - a.place);
                          return corner(vertices_.add(place), place);
                      });
            if (!below.empty()) keep(std::move(below), index);
            rest = std::move(above);
        }
        if (!rest.empty()) keep(std::move(rest), index);
    }

    const Surface& surface_;
    double precision_;
    Frame frame_;
    VertexWelder& vertices_;
    std::vector<CellPiece> pieces_;
};

}  // namespace

std::vector<CellPiece> cut_into_cells(const FlatFaces& faces, const Group& group,
                                      const Surface& surface, const Precision& precision,
                                      VertexWelder& vertices) {
    CellCutter cutter(surface, precision.plane, vertices);
    for (const std::uint32_t index : group) {
        const Flat& flat = faces.flats[index];
        for (const auto piece : faces.pieces(flat)) cutter.cut(flat.face, piece);
    }
    return cutter.take();
}

std::vector<CellPiece> cut_into_cells(const Polygon& polygon, std::uint32_t face,
                                      const Surface& surface, const Precision& precision,
                                      VertexWelder& vertices) {
    CellCutter cutter(surface, precision.plane, vertices);
    cutter.cut(face, polygon);
    return cutter.take();
}

}  // namespace hemirad::meshing
