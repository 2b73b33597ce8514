#include "solver/patch_shapes.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "solver/patch_arrays.h"

namespace hemirad {
namespace {

PatchShape shape_of(const Mesh& mesh, const Patch& patch, double scale) {
    PatchShape shape;
    const int corner_count = patch.is_triangle() ? 3 : 4;
    for (int k = 0; k < corner_count; ++k)
        shape.corners.push_back(scale * mesh.vertices[patch.corners[k]]);
    shape.normal = mesh.normal(patch);
    shape.area = scale * scale * mesh.area(patch);
    shape.centre = scale * mesh.centroid(patch);
    shape.radius = 0;
    for (const glm::dvec3& corner : shape.corners)
        shape.radius = std::max(shape.radius, glm::distance(corner, shape.centre));
    return shape;
}

}  // namespace

std::vector<PatchShape> patch_shapes(const Mesh& mesh) {
    std::vector<PatchShape> shapes;
    const double scale = unit_scale(mesh);
    for (const Patch& patch : mesh.patches) shapes.push_back(shape_of(mesh, patch, scale));
    return shapes;
}

std::vector<PatchShape> shooter_shapes(const Mesh& mesh) {
    std::vector<PatchShape> shapes;
    const double scale = unit_scale(mesh);
    for (const Shooter& shooter : mesh.shooters)
        shapes.push_back(shape_of(mesh, {shooter.corners, shooter.surface}, scale));
    return shapes;
}

}  // namespace hemirad
