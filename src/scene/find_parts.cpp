#include "scene/find_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numbers>

#include "scene/disjoint_sets.h"

namespace hemirad::meshing {
namespace {

using Vertices = std::vector<glm::dvec3>;

// Joins what shares an edge; returns the edges that are not passed equally often both ways.
std::vector<Edge> join_over_edges(std::span<const Edge> edges, DisjointSets& flats) {
    std::vector<Edge> open;
    for_each_shared(edges, [&](std::span<const Edge> shared) {
        std::ptrdiff_t balance = 0;
        for (const Edge& edge : shared) {
            flats.join(edge.owner, shared.front().owner);
            balance += edge.ascending ? 1 : -1;
        }
        if (balance != 0) open.insert(open.end(), shared.begin(), shared.end());
    });
    return open;
}

/// One end of an open edge.
struct EdgeEnd {
    std::uint32_t vertex;
    std::uint32_t edge;
    auto operator<=>(const EdgeEnd&) const = default;
};

std::vector<EdgeEnd> ends_of(std::span<const Edge> edges) {
    std::vector<EdgeEnd> ends;
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
        ends.push_back({edges[e].low(), e});
        ends.push_back({edges[e].high(), e});
    }
    std::ranges::sort(ends);
    return ends;
}

std::uint32_t other_end(const Edge& edge, std::uint32_t vertex) {
    return edge.low() == vertex ? edge.high() : edge.low();
}

// Two edges that meet are on one line where the shorter one ends no farther from the longer one's
// line than coordinates are precise.
bool on_one_line(const glm::dvec3& a, const glm::dvec3& b, double precision) {
    const double longer = std::max(glm::length(a), glm::length(b));
    return glm::length(glm::cross(a, b)) <= precision * longer;
}

/// An edge from a vertex where it may meet thousands of others.
struct Spoke {
    std::uint32_t edge;
    glm::dvec3 along;
    double place = 0;  ///< of its direction, whichever way, on an axis
    double play =
        std::numeric_limits<double>::infinity();  ///< from there, of longer ones on its line
};

Spoke spoke_of(std::uint32_t edge, const glm::dvec3& along, double precision) {
    const glm::dvec3 axis(0.48, 0.6, 0.64);  // unlike those that scenes are built along
    Spoke spoke{edge, along};
    const double length = glm::length(along);
    if (!(length > precision)) return spoke;
    spoke.place = std::abs(glm::dot(axis, along)) / length;
    spoke.play = 2 * precision / length + 1e-12;  // a chord is below pi / 2 sines; and rounding
    return spoke;
}

// Those that meet at a vertex: each with its neighbours on the axis, the shorter one with the
// longer.
void join_spokes(std::vector<Spoke>& spokes, double precision, DisjointSets& lines) {
    std::ranges::sort(spokes, {}, &Spoke::place);
    for (auto own = spokes.begin(); own != spokes.end(); ++own) {
        const auto join = [&](const Spoke& other) {
            if (on_one_line(own->along, other.along, precision)) lines.join(own->edge, other.edge);
        };
        for (auto at = own; at != spokes.begin() && own->place - at[-1].place <= own->play; --at)
            join(at[-1]);
        for (auto at = own + 1; at != spokes.end() && at->place - own->place <= own->play; ++at)
            join(*at);
    }
}

DisjointSets join_on_lines(std::span<const Edge> edges, std::span<const EdgeEnd> ends,
                           const Vertices& vertices, double precision) {
    DisjointSets lines(edges.size());
    std::vector<Spoke> spokes;
    for (std::size_t begin = 0, end = 0; begin < ends.size(); begin = end) {
        const std::uint32_t hub = ends[begin].vertex;
        spokes.clear();
        for (; end < ends.size() && ends[end].vertex == hub; ++end)
            spokes.push_back(spoke_of(
                ends[end].edge, vertices[other_end(edges[ends[end].edge], hub)] - vertices[hub],
                precision));
        join_spokes(spokes, precision, lines);
    }
    return lines;
}

// Directed edges on one line cover every point of it equally often both ways where each vertex is
// left as often as it is entered.
std::vector<bool> find_open_lines(std::span<const Edge> edges, std::span<const EdgeEnd> ends,
                                  DisjointSets& lines) {
    std::vector<bool> open(edges.size(), false);
    for (std::size_t begin = 0, end = 0; begin < ends.size(); begin = end) {
        std::map<std::uint32_t, std::ptrdiff_t> left_less_entered;
        for (; end < ends.size() && ends[end].vertex == ends[begin].vertex; ++end) {
            const Edge& edge = edges[ends[end].edge];
            const bool leaves = edge.from() == ends[end].vertex;
            left_less_entered[lines.find(ends[end].edge)] += leaves ? 1 : -1;
        }
        for (const auto& [line, difference] : left_less_entered)
            if (difference != 0) open[line] = true;
    }
    return open;
}

// Within a line, edges were compared with the next: a round rim that bends little from each to the
// next is none. Of a line, all vertices lie near that through two far apart.
void open_bent_lines(std::span<const Edge> edges, const Vertices& vertices, double precision,
                     DisjointSets& lines, std::vector<bool>& open) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> on_lines;
    for (std::uint32_t e = 0; e < edges.size(); ++e)
        for (const std::uint32_t vertex : {edges[e].low(), edges[e].high()})
            on_lines.emplace_back(lines.find(e), vertex);
    std::ranges::sort(on_lines);
    for (std::size_t begin = 0, end = 0; begin < on_lines.size(); begin = end) {
        const std::uint32_t line = on_lines[begin].first;
        while (end < on_lines.size() && on_lines[end].first == line) ++end;
        const auto own = std::span(on_lines).subspan(begin, end - begin);
        const auto farthest = [&](const glm::dvec3& from) {
            return vertices[std::ranges::max_element(own, {}, [&](const auto& at) {
                                return glm::distance(vertices[at.second], from);
                            })->second];
        };
        const glm::dvec3 from = farthest(vertices[own.front().second]);
        const glm::dvec3 along = farthest(from) - from;
        if (std::ranges::any_of(own, [&](const auto& at) {
                const double area = glm::length(glm::cross(vertices[at.second] - from, along));
                return area > 2 * precision * glm::length(along);
            }))
            open[line] = true;
    }
}

// Returns the edges that stay open; joins the flats along the others.
std::vector<Edge> join_over_t_junctions(std::span<const Edge> edges, const Vertices& vertices,
                                        double precision, DisjointSets& flats) {
    const auto ends = ends_of(edges);
    DisjointSets lines = join_on_lines(edges, ends, vertices, precision);
    auto open_lines = find_open_lines(edges, ends, lines);
    open_bent_lines(edges, vertices, precision, lines, open_lines);
    std::vector<Edge> open;
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
        const std::uint32_t line = lines.find(e);
        if (open_lines[line])
            open.push_back(edges[e]);
        else
            flats.join(edges[e].owner, edges[line].owner);
    }
    return open;
}

/// What decides whether parts lie inside each other.
struct Extent {
    glm::dvec3 low = glm::dvec3(std::numeric_limits<double>::infinity());
    glm::dvec3 high = -low;
    double volume = 0;  ///< negative where the fronts face inwards: a room
};

bool lies_in(const Extent& inner, const Extent& outer) {
    return glm::all(glm::greaterThanEqual(inner.low, outer.low)) &&
           glm::all(glm::lessThanEqual(inner.high, outer.high));
}

// Divergence theorem: a third of the flux of the position, from a point near to lose no digits.
std::vector<Extent> measure(const FlatFaces& faces, const Parts& parts, const Vertices& vertices) {
    std::vector<Extent> extents(parts.parts.size());
    std::vector<const glm::dvec3*> base(parts.parts.size(), nullptr);
    for (std::uint32_t f = 0; f < faces.flats.size(); ++f) {
        const auto outline = faces.outline(faces.flats[f]);
        const std::uint32_t part = parts.part_of_flat[f];
        Extent& extent = extents[part];
        if (!base[part]) base[part] = &vertices[outline[0]];
        extent.volume +=
            glm::dot(vertices[outline[0]] - *base[part], area_vector(outline, vertices)) / 3;
        for (const std::uint32_t v : outline) {
            extent.low = glm::min(extent.low, vertices[v]);
            extent.high = glm::max(extent.high, vertices[v]);
        }
    }
    return extents;
}

// Bounding boxes stand in for the shapes: a solid beside an L-shaped room but within its box
// passes for one inside it.
bool encloses_all(const Parts& parts, const std::vector<Extent>& extents) {
    std::vector<Extent> rooms;
    for (const Extent& extent : extents)
        if (extent.volume < 0) rooms.push_back(extent);
    std::ranges::sort(rooms, std::greater{}, [](const Extent& room) { return -room.volume; });
    return std::ranges::all_of(parts.parts, &Part::closed) &&
           std::ranges::all_of(extents, [&](const Extent& inner) {
               return std::ranges::any_of(rooms,
                                          [&](const Extent& room) { return lies_in(inner, room); });
           });
}

// Of a triangle seen from a point, over 4 pi (Van Oosterom and Strackee 1983).
double part_of_sphere(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double volume = glm::dot(a, glm::cross(b, c));
    const double rest =
        la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return std::atan2(volume, rest) / (2 * std::numbers::pi);
}

// How often a part goes round a point: 1 inside a solid, 0 outside.
double turns_round(const FlatFaces& faces, const Parts& parts, std::uint32_t part,
                   const Vertices& vertices, const glm::dvec3& eye) {
    double turns = 0;
    for (std::uint32_t f = 0; f < faces.flats.size(); ++f) {
        if (parts.part_of_flat[f] != part) continue;
        const auto outline = faces.outline(faces.flats[f]);
        for (std::size_t i = 1; i + 1 < outline.size(); ++i)
            turns += part_of_sphere(vertices[outline[0]] - eye, vertices[outline[i]] - eye,
                                    vertices[outline[i + 1]] - eye);
    }
    return turns;
}

// The others are asked by the middle of their boxes: one that lies on the part itself is gone half
// round. Of many a few are asked.
std::optional<InsideOut> find_inside_out(const FlatFaces& faces, const Parts& parts,
                                         const std::vector<Extent>& extents,
                                         const Vertices& vertices) {
    constexpr std::size_t kMostAsked = 16;
    if (parts.parts.size() < 2) return {};
    const auto largest = std::ranges::max_element(extents, {}, &Extent::volume);
    const auto part = static_cast<std::uint32_t>(largest - extents.begin());
    if (!parts.parts[part].closed || !(largest->volume > 0)) return {};
    for (const Extent& other : extents)
        if (!lies_in(other, *largest)) return {};
    for (std::size_t p = 0, asked = 0; p < extents.size() && asked < kMostAsked; ++p) {
        if (p == part) continue;
        const glm::dvec3 middle = 0.5 * extents[p].low + 0.5 * extents[p].high;
        if (turns_round(faces, parts, part, vertices, middle) < 0.25) return {};
        ++asked;
    }
    const auto first = std::ranges::find(parts.part_of_flat, part) - parts.part_of_flat.begin();
    return InsideOut{part, vertices[faces.outline(faces.flats[std::size_t(first)])[0]]};
}

bool emits(const Material& material) {
    return std::ranges::any_of(material.emission, [](double value) { return value > 0; });
}

glm::dvec3 mean_corner(std::span<const std::uint32_t> outline, const Vertices& vertices) {
    glm::dvec3 mean(0);
    for (const std::uint32_t v : outline) mean += vertices[v] / double(outline.size());
    return mean;
}

bool lies_in(const glm::dvec3& point, const Extent& extent) {
    return lies_in(Extent{point, point}, extent);
}

// Solids around a lamp's face. Where there are too many to ask, those whose boxes hold one: nobody
// but who is inside sees the backs that they get.
void find_light_holders(const Scene& scene, const FlatFaces& faces,
                        const std::vector<Extent>& extents, const Vertices& vertices,
                        Parts& parts) {
    constexpr std::size_t kMostLooks = 1'000'000'000;  // at a face: a second or two
    std::size_t looks = 0;
    for (std::uint32_t f = 0; f < faces.flats.size(); ++f) {
        const Flat& flat = faces.flats[f];
        if (!emits(scene.materials[scene.faces[flat.face].material])) continue;
        const glm::dvec3 eye = mean_corner(faces.outline(flat), vertices);
        for (std::uint32_t p = 0; p < parts.parts.size(); ++p) {
            Part& part = parts.parts[p];
            if (p == parts.part_of_flat[f] || !part.closed || part.holds_light) continue;
            if (!(extents[p].volume > 0) || !lies_in(eye, extents[p])) continue;
            looks += faces.flats.size();
            part.holds_light =
                looks > kMostLooks || turns_round(faces, parts, p, vertices, eye) > 0.75;
        }
    }
}

void list_parts(const Scene& scene, const FlatFaces& faces, DisjointSets& sets, Parts& parts) {
    constexpr std::uint32_t kUnseen = 0xffffffffu;
    std::vector<std::uint32_t> part_of_root(faces.flats.size(), kUnseen);
    for (std::uint32_t f = 0; f < faces.flats.size(); ++f) {
        std::uint32_t& index = part_of_root[sets.find(f)];
        if (index == kUnseen) {
            index = static_cast<std::uint32_t>(parts.parts.size());
            parts.parts.emplace_back().closed = true;
        }
        parts.part_of_flat.push_back(index);
        Part& part = parts.parts[index];
        const Face& face = scene.faces[faces.flats[f].face];
        if (part.objects.empty() || part.objects.back() != face.object)
            part.objects.push_back(face.object);
        if (scene.materials[face.material].double_sided) part.doubled = true;
        if (f == 0 || faces.flats[f - 1].face != faces.flats[f].face) ++part.face_count;
    }
    for (Part& part : parts.parts) {
        std::ranges::sort(part.objects);
        const auto repeated = std::ranges::unique(part.objects);
        part.objects.erase(repeated.begin(), repeated.end());
    }
}

}  // namespace

Parts find_parts(const Scene& scene, const FlatFaces& faces, std::span<const Edge> edges,
                 const Vertices& vertices, const Precision& precision) {
    DisjointSets sets(faces.flats.size());
    const auto unbalanced = join_over_edges(edges, sets);
    const auto open = join_over_t_junctions(unbalanced, vertices, precision.plane, sets);

    Parts parts;
    list_parts(scene, faces, sets, parts);
    for (const Edge& edge : open) parts.parts[parts.part_of_flat[edge.owner]].closed = false;
    const auto extents = measure(faces, parts, vertices);
    parts.encloses_all = encloses_all(parts, extents);
    parts.inside_out = find_inside_out(faces, parts, extents, vertices);
    find_light_holders(scene, faces, extents, vertices, parts);
    return parts;
}

}  // namespace hemirad::meshing
