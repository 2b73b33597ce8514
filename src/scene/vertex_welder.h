#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace hemirad::meshing {

/// Gives every position an index, and positions within a tolerance of each other the same one. The
/// first to come stays, bit for bit; whoever comes later is moved to it.
class VertexWelder {
  public:
    explicit VertexWelder(double tolerance, std::size_t expected = 0);

    std::uint32_t add(const glm::dvec3& position);
    /// The same, but only positions that differ by no more than rounding become one: where a vertex
    /// has to lie on an edge.
    std::uint32_t add_apart(const glm::dvec3& position);
    void move(std::uint32_t vertex, const glm::dvec3& to);

    const std::vector<glm::dvec3>& positions() const { return positions_; }
    const glm::dvec3& operator[](std::uint32_t vertex) const { return positions_[vertex]; }

  private:
    using Cell = std::array<std::int64_t, 3>;

    Cell cell_of(const glm::dvec3& position) const;
    std::uint32_t bucket_of(const Cell& cell) const;
    std::uint32_t add(const glm::dvec3& position, double tolerance);
    std::uint32_t find_in(const Cell& cell, const glm::dvec3& position, double tolerance) const;
    std::uint32_t find(const glm::dvec3& position, double tolerance) const;
    void link(std::uint32_t vertex);
    void unlink(std::uint32_t vertex);
    void grow();

    double tolerance_;
    double cell_size_;
    std::vector<glm::dvec3> positions_;
    std::vector<std::uint32_t> heads_;  ///< first vertex of each bucket
    std::vector<std::uint32_t> next_;   ///< next vertex in the same bucket
};

}  // namespace hemirad::meshing
