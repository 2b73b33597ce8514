#include "scene/cut_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/split_polygon.h"

namespace hemirad::meshing {
namespace {

class CellCutter {
  public:
    CellCutter(const Surface& surface, double precision, VertexWelder& vertices)
        : surface_(surface),
          precision_(precision),
          splitter_({surface.origin, surface.u_axis, surface.v_axis, surface.normal}, vertices,
                    NewVertices::welded) {}

    void cut(std::uint32_t face, std::span<const std::uint32_t> piece) {
        Polygon polygon;
        for (const std::uint32_t v : piece) polygon.push_back(splitter_.corner(v));
        cut(face, std::move(polygon));
    }

    void cut(std::uint32_t face, Polygon polygon) {
        face_ = face;
        slice(std::move(polygon), 0, surface_.columns, [&](Polygon strip, std::uint32_t column) {
            slice(std::move(strip), 1, surface_.rows, [&](Polygon cell, std::uint32_t row) {
                pieces_.push_back({row * surface_.columns + column, face_, std::move(cell)});
            });
        });
    }

    std::vector<CellPiece> take() {
        std::ranges::stable_sort(pieces_, {}, &CellPiece::cell);
        return std::move(pieces_);
    }

  private:
    // Cuts along the lines across one axis, lowest first, and hands each slice to `keep`.
    template <class Keep>
    void slice(Polygon rest, int axis, std::uint32_t count, Keep keep) {
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
            auto [below, above] = splitter_.split(rest, line, precision_);
            if (!below.empty()) keep(std::move(below), index);
            rest = std::move(above);
        }
        if (!rest.empty()) keep(std::move(rest), index);
    }

    const Surface& surface_;
    double precision_;
    PolygonSplitter splitter_;
    std::uint32_t face_ = 0;
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
