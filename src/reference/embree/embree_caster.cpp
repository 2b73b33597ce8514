#include "reference/embree/embree_caster.h"

#include <embree3/rtcore.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <stdexcept>
#include <vector>

#include "reference/projector.h"

namespace hemirad::reference {
namespace {

// Back faces hide nothing: where a ray leaves through one, it goes on.
void reject_back(const RTCFilterFunctionNArguments* arguments) {
    const auto* const normals = static_cast<const glm::vec3*>(arguments->geometryUserPtr);
    const auto* const ray = reinterpret_cast<const RTCRay*>(arguments->ray);
    const auto* const hit = reinterpret_cast<const RTCHit*>(arguments->hit);
    const glm::vec3 direction(ray->dir_x, ray->dir_y, ray->dir_z);
    if (glm::dot(normals[hit->primID], direction) >= 0) arguments->valid[0] = 0;
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
    std::vector<glm::vec3> normals;

    ~Scene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

EmbreeCaster::EmbreeCaster(std::span<const Polygon> polygons) : scene_(std::make_unique<Scene>()) {
    for (const Polygon& polygon : polygons) scene_->normals.emplace_back(normal(polygon));
    const RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_QUAD);
    set_corners(geometry, polygons);
    rtcSetGeometryUserData(geometry, scene_->normals.data());
    rtcSetGeometryIntersectFilterFunction(geometry, reject_back);
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
