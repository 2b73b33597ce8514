#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "reference/polygon.h"

/// What a shooter sees through each proxel of its hemisphere's base disk (sec. 1.3.2), in double
/// precision and by ray casting: an oracle for the kernels that shares nothing with them.
namespace hemirad::reference {

/// The frame of a hemisphere; normal and u_axis are orthonormal, and v = normal x u.
struct Shooter {
    glm::dvec3 origin, normal, u_axis;
};

inline constexpr int kEscaped = -1;  ///< a proxel that no polygon owns
inline constexpr int kOutsideDisk =
    -2;  ///< a proxel of the square whose centre the disk leaves out

/// Whether the centre ((2 column + 1 - N) / N, (2 row + 1 - N) / N) lies inside the unit disk.
bool in_disk(int column, int row, int resolution);
std::uint64_t disk_proxel_count(int resolution);

/// Owners of all proxels, row * resolution + column, and how far they can be trusted.
struct Truth {
    int resolution = 0;
    std::vector<int> owner;  ///< index of a polygon, kEscaped or kOutsideDisk
    /// Proxels whose owner depends on rounding, with every owner that rounding admits, in
    /// increasing order: the nominal one among them, and kEscaped where each hit is marginal.
    std::map<std::size_t, std::vector<int>> undecided;

    bool decided(std::size_t proxel) const { return !undecided.contains(proxel); }
    bool admits(std::size_t proxel, int candidate) const;
    std::uint64_t count(int candidate) const;  ///< proxels that `candidate` owns
};

/// How far a point of a polygon may lie from where it is said to: at a distance r from the origin
/// by up to relative * r + absolute, in the unit of the coordinates.
struct Bound {
    double relative = 0, absolute = 0;
    /// What a normal may be turned by, radians: less than displaced corners turn it, where it is
    /// known otherwise. The displacement covers what this moves a polygon's points by.
    double turn = std::numeric_limits<double>::infinity();
};

/// What the projector's doubles err by, as Bound::relative: below, proxels are not decided in
/// truth.
inline constexpr double kProjectorRounding = 2e-15;

/// Owner of each proxel: the nearest polygon that turns its front to the origin, the lowest index
/// of equally near ones. A proxel is undecided where polygons whose points moved by up to `bound`
/// relative to the proxel's ray could change its owner. Polygons move independently, so an edge
/// that two of them share may open by twice the bound.
Truth project(const Shooter& shooter, std::span<const Polygon> polygons, int resolution,
              const Bound& bound = {});
inline Truth project(const Shooter& shooter, std::span<const Polygon> polygons, int resolution,
                     double absolute) {
    return project(shooter, polygons, resolution, Bound{.absolute = absolute});
}

}  // namespace hemirad::reference
