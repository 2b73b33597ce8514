#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace hemirad::meshing {

/// (1, 2, 3), to nine digits: enough also far from the origin.
std::string place_text(const glm::dvec3& at);

/// Warnings of one kind about faces: the first few in full, the rest as a count.
class FaceWarnings {
  public:
    FaceWarnings(const Scene& scene, std::string what) : scene_(scene), what_(std::move(what)) {}

    void add(std::uint32_t face);
    void append_to(std::vector<std::string>& warnings) const;
    std::uint32_t count() const { return count_; }

  private:
    const Scene& scene_;
    std::string what_;
    std::vector<std::string> lines_;
    std::uint32_t count_ = 0;
};

}  // namespace hemirad::meshing
