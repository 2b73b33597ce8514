#include "reference/embree/embree_caster.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <stdexcept>
#include <vector>

#include "reference/projector.h"

namespace hemirad::reference {
namespace {

/// A point x is at height dot(normal, x) - offset.
struct Plane {
    glm::vec3 normal;
    float offset;
};

struct Planes {
    std::vector<Plane> planes;  ///< [polygon]
    float least_height;
};

// Back faces hide nothing, nor what the ray's origin is in the plane of: the ray goes on. Met from
// above its plane, a polygon shows its front.
void reject_unseen(const RTCFilterFunctionNArguments* arguments) {
    const auto& seen = *static_cast<const Planes*>(arguments->geometryUserPtr);
    const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
    const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
    const auto& [normal, offset] = seen.planes[hit.primID];
    const float height = glm::dot(normal, {ray.org_x, ray.org_y, ray.org_z}) - offset;
    if (height <= seen.least_height) arguments->valid[0] = 0;
}

Planes planes_of(std::span<const Polygon> polygons) {
    constexpr float kInPlane = 1e-6f;  // a few times what floats round
    Planes result;
    double extent = 0;
    for (const Polygon& polygon : polygons) {
        const glm::dvec3 up = normal(polygon);
        result.planes.push_back({up, float(glm::dot(up, polygon.corners[0]))});
        for (const glm::dvec3& corner : polygon.corners)
            extent = std::max(extent, glm::length(corner));
    }
    result.least_height = kInPlane * float(extent);
    return result;
}

void set_corners(RTCGeometry geometry, std::span<const Polygon> polygons) {
    auto* const vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), 4 * polygons.size()));
    auto* const indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                4 * sizeof(unsigned), polygons.size()));
    if (!vertices || !indices) throw std::runtime_error("Embree: no memory for its buffers");
    for (std::size_t i = 0; i < 4 * polygons.size(); ++i) {
        const glm::dvec3& corner = polygons[i / 4].corners[i % 4];
        for (int axis = 0; axis < 3; ++axis) vertices[3 * i + axis] = float(corner[axis]);
        indices[i] = unsigned(i);
    }
}

}  // namespace

struct EmbreeCaster::Scene {
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene scene = rtcNewScene(device);
    Planes planes;

    ~Scene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

EmbreeCaster::EmbreeCaster(std::span<const Polygon> polygons) : scene_(std::make_unique<Scene>()) {
    scene_->planes = planes_of(polygons);
    const RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_QUAD);
    set_corners(geometry, polygons);
    rtcSetGeometryUserData(geometry, &scene_->planes);
    rtcSetGeometryIntersectFilterFunction(geometry, reject_unseen);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene_->scene);
}

EmbreeCaster::~EmbreeCaster() = default;
EmbreeCaster::EmbreeCaster(EmbreeCaster&&) noexcept = default;

int EmbreeCaster::operator()(const glm::dvec3& origin, const glm::dvec3& direction) const {
    RTCRayHit ray{};
    ray.ray.org_x = float(origin.x);
    ray.ray.org_y = float(origin.y);
    ray.ray.org_z = float(origin.z);
    ray.ray.dir_x = float(direction.x);
    ray.ray.dir_y = float(direction.y);
    ray.ray.dir_z = float(direction.z);
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_->scene, &context, &ray);
    return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kEscaped : int(ray.hit.primID);
}

}  // namespace hemirad::reference
