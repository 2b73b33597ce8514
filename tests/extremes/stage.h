#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference/projector.h"
#include "support/pipeline.h"

/// One pipeline for many small scenes, and how what it sees agrees with double precision.
namespace hemirad::test {

/// What the device may move a polygon by, either way. Of the farther end's distance kEdgeMargin
/// moves an edge outwards, and covers what single precision can move it inwards or farther outwards
/// by; so twice that, and of kGridMargin alike. A normal is rounded (e = 2^-24, each component by
/// its own e/2), turned into the shooter's frame (three products and sums, 3 e sqrt 3) and
/// multiplied by the ray (4 e): below 10 e in all.
inline reference::Bound device_bound() {
    return {2.0 * kEdgeMargin, 2.0 * kGridMargin, 10 * 0x1p-24};
}

/// Proxels of one or many hemispheres, compared.
struct Agreement {
    std::uint64_t proxels = 0, undecided = 0, wrong = 0;
    std::string first_wrong;

    Agreement& operator+=(const Agreement& other) {
        if (wrong == 0) first_wrong = other.first_wrong;
        proxels += other.proxels;
        undecided += other.undecided;
        wrong += other.wrong;
        return *this;
    }
};

inline std::string admitted(const reference::Truth& truth, std::size_t proxel) {
    if (truth.decided(proxel)) return std::to_string(truth.owner[proxel]);
    std::string all;
    for (const int owner : truth.undecided.at(proxel)) all += std::to_string(owner) + " ";
    return all;
}

inline Agreement agreement(const std::vector<int>& owners, const reference::Truth& truth) {
    Agreement result;
    const auto resolution = static_cast<std::size_t>(truth.resolution);
    for (std::size_t proxel = 0; proxel < owners.size(); ++proxel) {
        if (truth.owner[proxel] != reference::kOutsideDisk) ++result.proxels;
        if (truth.admits(proxel, owners[proxel])) continue;
        if (result.wrong++ == 0)
            result.first_wrong = "column " + std::to_string(proxel % resolution) + ", row " +
                                 std::to_string(proxel / resolution) + ": " +
                                 std::to_string(owners[proxel]) + " instead of " +
                                 admitted(truth, proxel);
    }
    result.undecided = truth.undecided.size();
    return result;
}

class Stage {
  public:
    explicit Stage(std::uint32_t resolution, FormFactorMode mode = FormFactorMode::count,
                   const Shape& shape = {4, 1, 16, 64, 64})
        : resolution_(static_cast<int>(resolution)),
          arrays_(patch_arrays(mesh_of(box({1, 1, 1}, 1)))),
          device_(mp1map::Device::open("")),
          pipeline_(arrays_, even_light(arrays_), settings(resolution, mode, shape), device_) {
        pipeline_.init_plane();
    }

    /// Up to kReduceBlock polygons, not all of them triangles: other pipelines do those.
    void show(const std::vector<Polygon>& polygons) {
        auto arrays = patch_arrays(mesh_of(polygons));
        if (arrays.stride != arrays_.stride || arrays.corner_count != arrays_.corner_count)
            throw std::invalid_argument("a scene that its stage has no room for");
        polygons_ = normalised(polygons, arrays);
        arrays_ = arrays;
        pipeline_.load(arrays_);
    }

    /// The frame that aim_hemisphere makes; normalised.
    reference::Shooter aim(int patch) {
        pipeline_.set_shooter(static_cast<std::uint32_t>(patch));
        pipeline_.aim_hemisphere();
        return shooter();
    }

    /// What a patch sees, in the reference's numbering.
    std::vector<int> owners_seen_by(int patch) {
        pipeline_.clear_counts();
        pipeline_.set_shooter(static_cast<std::uint32_t>(patch));
        project_hemisphere(pipeline_);
        return owners_in(pipeline_);
    }

    Agreement agreement_of(int patch) {
        const auto owners = owners_seen_by(patch);
        return agreement(owners,
                         reference::project(shooter(), polygons_, resolution_, device_bound()));
    }

    reference::Shooter in_world(reference::Shooter frame) const {
        frame.origin = frame.origin / arrays_.scale + arrays_.centre;
        return frame;
    }
    const std::vector<Polygon>& polygons() const { return polygons_; }  ///< normalised
    ShotPipeline& pipeline() { return pipeline_; }
    int resolution() const { return resolution_; }

  private:
    static PipelineSettings settings(std::uint32_t resolution, FormFactorMode mode,
                                     const Shape& shape) {
        PipelineSettings result;
        result.resolution = resolution;
        result.form_factor = mode;
        result.pe_array = shape.request();
        result.keep_owners = true;
        return result;
    }
    reference::Shooter shooter() {
        const auto shot = pipeline_.shot();
        const auto axis = [](const float* v) { return glm::dvec3(v[0], v[1], v[2]); };
        return {grid_point(shot.origin), axis(shot.normal), axis(shot.u_axis)};
    }

    int resolution_;
    PatchArrays arrays_;
    std::vector<Polygon> polygons_;
    mp1map::Device device_;
    ShotPipeline pipeline_;
};

/// The direction of a proxel's centre.
inline glm::dvec3 ray_of(const reference::Shooter& frame, int column, int row, int resolution) {
    const double u = double(2 * column + 1 - resolution) / resolution;
    const double v = double(2 * row + 1 - resolution) / resolution;
    return u * frame.u_axis + v * glm::cross(frame.normal, frame.u_axis) +
           std::sqrt(1 - u * u - v * v) * frame.normal;
}

inline std::string text(const glm::dvec3& point) {
    std::ostringstream out;
    out.precision(17);
    out << "{" << point.x << ", " << point.y << ", " << point.z << "}";
    return out.str();
}

inline std::string text(const std::vector<Polygon>& polygons) {
    std::string all;
    for (const auto& polygon : polygons) {
        all += "{{";
        for (const auto& corner : polygon.corners) all += text(corner) + ", ";
        all += "}},\n";
    }
    return all;
}

}  // namespace hemirad::test
