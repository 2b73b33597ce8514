#include "scene/cut_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/frame.h"

namespace hemirad::meshing {
namespace {

struct Halves {
    Polygon below, above;
};

void remove_repeats(Polygon& polygon) {
    const auto repeated = std::ranges::unique(polygon, {}, &Corner::vertex);
    polygon.erase(repeated.begin(), repeated.end());
    while (polygon.size() > 1 && polygon.front().vertex == polygon.back().vertex)
        polygon.pop_back();
    if (polygon.size() < 3) polygon.clear();
}

class CellCutter {
  public:
    CellCutter(const Surface& surface, double precision, VertexWelder& vertices)
        : surface_(surface),
          frame_{surface.origin, surface.u_axis, surface.v_axis, surface.normal},
          precision_(precision),
          vertices_(vertices) {}

    void cut(std::uint32_t face, std::span<const std::uint32_t> piece) {
        Polygon polygon;
        for (const std::uint32_t v : piece) polygon.push_back(corner(v));
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
    Corner corner(std::uint32_t vertex) const {
        return {vertex, frame_.project(vertices_[vertex])};
    }

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
            auto [below, above] = split(rest, axis, (index + 1) * size);
            if (!below.empty()) keep(std::move(below), index);
            rest = std::move(above);
        }
        if (!rest.empty()) keep(std::move(rest), index);
    }

    int side(const Corner& c, int axis, double line) const {
        const double beyond = c.at[axis] - line;
        return beyond > precision_ ? 1 : beyond < -precision_ ? -1 : 0;
    }

    // Sutherland and Hodgman (1974), both sides at once.
    Halves split(const Polygon& polygon, int axis, double line) {
        Halves halves;
        bool reaches_below = false;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Corner& a = polygon[i];
            const Corner& b = polygon[(i + 1) % polygon.size()];
            const int side_a = side(a, axis, line);
            if (side_a <= 0) halves.below.push_back(a);
            if (side_a >= 0) halves.above.push_back(a);
            if (side_a < 0) reaches_below = true;
            if (side_a * side(b, axis, line) >= 0) continue;
            const Corner crossing = cross(a, b, axis, line);
            halves.below.push_back(crossing);
            halves.above.push_back(crossing);
        }
        if (!reaches_below) halves.below.clear();
        remove_repeats(halves.below);
        remove_repeats(halves.above);
        return halves;
    }

    Corner cross(const Corner& a, const Corner& b, int axis, double line) {
        const double fraction = (line - a.at[axis]) / (b.at[axis] - a.at[axis]);
        const glm::dvec3 from = vertices_[a.vertex];
        return corner(vertices_.add(from + fraction * (vertices_[b.vertex] - from)));
    }

    const Surface& surface_;
    Frame frame_;
    double precision_;
    VertexWelder& vertices_;
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
