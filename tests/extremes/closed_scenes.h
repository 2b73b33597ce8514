#pragma once

#include <array>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "solver/support.h"

/// Closed scenes made patch by patch, and what escapes from them.
namespace hemirad::test {

/// Polygons and the face that each is a piece of: pieces of one lie in one plane.
struct Pieces {
    std::vector<Polygon> polygons;
    std::vector<std::uint32_t> faces;

    void add(const Polygon& polygon, std::uint32_t face) {
        polygons.push_back(polygon);
        faces.push_back(face);
    }
    std::uint32_t face_count() const { return faces.empty() ? 0 : faces.back() + 1; }
};

inline Mesh mesh_of(const Pieces& pieces) {
    Mesh mesh = mesh_of(pieces.polygons);
    for (std::size_t patch = 0; patch < pieces.faces.size(); ++patch)
        mesh.surfaces[patch].plane = pieces.faces[patch];
    mesh.closed = true;
    return mesh;
}

inline glm::dvec3 random_direction(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

/// Facets, fronts outwards, of the hull of `count` random points of an ellipsoid.
inline std::vector<std::array<glm::dvec3, 3>> random_hull(int count, const glm::dvec3& half,
                                                          std::mt19937_64& random) {
    std::vector<glm::dvec3> points(count);
    for (auto& point : points) point = half * random_direction(random);
    std::vector<std::array<glm::dvec3, 3>> facets;
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j)
            for (int k = j + 1; k < count; ++k) {
                const auto normal = glm::cross(points[j] - points[i], points[k] - points[i]);
                int above = 0;
                for (int other = 0; other < count; ++other)
                    if (other != i && other != j && other != k)
                        above += glm::dot(normal, points[other] - points[i]) > 0;
                if (above == 0) facets.push_back({points[i], points[j], points[k]});
                if (above == count - 3) facets.push_back({points[i], points[k], points[j]});
            }
    return facets;
}

inline Polygon triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return {{a, b, c, c}};
}

/// How a facet is cut.
enum class Cut {
    whole,
    fan,         ///< about a point inside: edges are shared
    quarters,    ///< at its edges' middles, the same doubles from both sides
    t_junctions  ///< at points of its edges, of which its neighbours know nothing
};

inline void add_cut(Pieces& pieces, const std::array<glm::dvec3, 3>& facet, Cut cut,
                    std::mt19937_64& random) {
    const auto& [a, b, c] = facet;
    const std::uint32_t face = pieces.face_count();
    std::uniform_real_distribution<double> share(0.05, 0.95);
    if (cut == Cut::whole) {
        pieces.add(triangle(a, b, c), face);
    } else if (cut == Cut::fan) {
        const double s = share(random), t = share(random) * (1 - s);
        const auto inside = a + s * (b - a) + t * (c - a);
        for (int k = 0; k < 3; ++k)
            pieces.add(triangle(facet[k], facet[(k + 1) % 3], inside), face);
    } else if (cut == Cut::quarters) {
        const auto ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
        pieces.add(triangle(a, ab, ca), face);
        pieces.add(triangle(b, bc, ab), face);
        pieces.add(triangle(c, ca, bc), face);
        pieces.add(triangle(ab, bc, ca), face);
    } else {
        const auto on_ab = a + share(random) * (b - a), on_bc = b + share(random) * (c - b);
        pieces.add(triangle(a, on_ab, c), face);
        pieces.add(triangle(on_ab, b, on_bc), face);
        pieces.add(triangle(on_ab, on_bc, c), face);
    }
}

/// The inside of a random polyhedron.
inline Pieces random_room(int points, const glm::dvec3& half, Cut cut, std::mt19937_64& random) {
    Pieces pieces;
    for (const auto& [a, b, c] : random_hull(points, half, random))
        add_cut(pieces, {c, b, a}, cut, random);
    return pieces;
}

/// Puts a closed polyhedron of `size` into a room, fronts outwards.
inline void add_object(Pieces& room, int points, double size, const glm::dvec3& at,
                       std::mt19937_64& random) {
    for (auto facet : random_hull(points, glm::dvec3(size), random)) {
        for (auto& corner : facet) corner += at;
        add_cut(room, facet, Cut::whole, random);
    }
}

struct Escapes {
    std::uint64_t shots = 0, proxels = 0, escaped = 0;
    std::uint32_t worst_shooter = 0, worst_part = 0;
    std::uint64_t worst = 0;

    Escapes& operator+=(const Escapes& other) {
        if (other.worst > worst) {
            worst = other.worst;
            worst_shooter = other.worst_shooter;
            worst_part = other.worst_part;
        }
        shots += other.shots;
        proxels += other.proxels;
        escaped += other.escaped;
        return *this;
    }
};

/// Shots from every `step`-th patch, each from another of its parts.
inline Escapes escapes_from(Shooters& shooters, std::uint32_t step = 1) {
    Escapes all;
    for (std::uint32_t patch = 0; patch < shooters.patch_count(); patch += step) {
        const auto part = static_cast<std::uint32_t>(all.shots % shooters.part_count());
        const auto count = shooters.count(patch, part);
        all += {1, count.owned + count.escaped, count.escaped, patch, part, count.escaped};
    }
    return all;
}
inline Escapes escapes_from(const Mesh& mesh, std::uint32_t resolution, std::uint32_t step = 1) {
    Shooters shooters(mesh, resolution, 3);
    return escapes_from(shooters, step);
}

}  // namespace hemirad::test
