#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "solver/solver.h"
#include "support/patches.h"

/// One shot on the default device, and what its shooter sees.
namespace hemirad::test {

/// A shape of the PE array under which every kernel has to give the same bits.
struct Shape {
    std::uint32_t width, height, lanes, tile_width, tile_height;

    mp1map::PeArrayRequest request() const {
        return {.width = width,
                .height = height,
                .lanes = lanes,
                .tile_width = tile_width,
                .tile_height = tile_height};
    }
};

inline std::string name_of(const Shape& shape) {
    return std::to_string(shape.width) + "x" + std::to_string(shape.height) + "_lanes" +
           std::to_string(shape.lanes) + "_tile" + std::to_string(shape.tile_width) + "x" +
           std::to_string(shape.tile_height);
}
inline std::ostream& operator<<(std::ostream& out, const Shape& shape) {
    return out << name_of(shape);
}

inline bool takes(const mp1map::DeviceSummary& device, const mp1map::PeArrayRequest& request) {
    try {
        mp1map::fit_pe_array(device, request);
        return true;
    } catch (const mp1map::NoSuchDevice&) {
        return false;
    }
}

/// Those that the default device takes: PoCL all of them, a GPU no groups of 64 x 64.
inline const std::vector<Shape>& shapes() {
    static const std::vector<Shape> taken = [] {
        const auto device = mp1map::Device::open("").summary();
        std::vector<Shape> all = {{4, 1, 16, 64, 64},  {8, 8, 1, 64, 64},   {16, 16, 4, 64, 64},
                                  {32, 32, 1, 32, 32}, {64, 64, 1, 64, 64}, {2, 3, 8, 48, 33}};
        std::erase_if(all, [&](const Shape& shape) { return !takes(device, shape.request()); });
        return all;
    }();
    return taken;
}

/// Where steps of the device's grid lie in the normalised scene.
inline glm::dvec3 grid_point(const std::int32_t* steps) {
    return double{kGridStep} * glm::dvec3(steps[0], steps[1], steps[2]);
}

/// Of the last hemisphere, in the reference's numbering: kEscaped for no patch, kOutsideDisk beyond
/// the disk.
inline std::vector<int> owners_in(ShotPipeline& pipeline) {
    std::vector<int> result;
    for (const int owner : pipeline.owners())
        result.push_back(owner == pipeline.escaped_owner()       ? reference::kEscaped
                         : owner == pipeline.escaped_owner() + 1 ? reference::kOutsideDisk
                                                                 : owner);
    return result;
}

/// A pipeline whose next shooter is `patch`, aimed and ready to be projected.
class Aimed {
  public:
    Aimed(const std::vector<Polygon>& polygons, const Shape& shape, std::uint32_t resolution,
          PipelineSettings base = {})
        : mesh_(mesh_of(polygons)),
          arrays_(patch_arrays(mesh_)),
          polygons_(normalised(polygons, arrays_)),
          device_(mp1map::Device::open("")),
          pipeline_(arrays_, even_light(arrays_), settings(base, shape, resolution), device_) {
        pipeline_.init_plane();
    }

    ShotPipeline& pipeline() { return pipeline_; }
    const PatchArrays& arrays() const { return arrays_; }
    const std::vector<Polygon>& polygons() const { return polygons_; }  ///< normalised

    void aim(int patch) {
        pipeline_.set_shooter(static_cast<std::uint32_t>(patch));
        pipeline_.aim_hemisphere();
        patch_ = patch;
    }
    void project() {
        pipeline_.set_shooter(static_cast<std::uint32_t>(patch_));
        project_hemisphere(pipeline_);
    }
    /// The frame that aim_hemisphere made.
    reference::Shooter shooter() {
        const auto shot = pipeline_.shot();
        const auto vector = [](const float* v) { return glm::dvec3(v[0], v[1], v[2]); };
        return {grid_point(shot.origin), vector(shot.normal), vector(shot.u_axis)};
    }
    std::vector<int> owners() { return owners_in(pipeline_); }  ///< as owners_in()

  private:
    static PipelineSettings settings(PipelineSettings result, const Shape& shape,
                                     std::uint32_t resolution) {
        const auto layout = result.pe_array.layout;
        const auto broadcast = result.pe_array.broadcast;
        result.resolution = resolution;
        result.pe_array = shape.request();
        result.pe_array.layout = layout;
        result.pe_array.broadcast = broadcast;
        result.keep_owners = true;
        return result;
    }

    Mesh mesh_;
    PatchArrays arrays_;
    std::vector<Polygon> polygons_;
    mp1map::Device device_;
    ShotPipeline pipeline_;
    int patch_ = 0;
};

}  // namespace hemirad::test
