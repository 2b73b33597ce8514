#pragma once

#include <initializer_list>

#include "view/lit_scene.h"

namespace hemirad {

/// A triangle in the last material, lit by one place of the lightmap unless `uvs` say more.
inline void add_triangle(LitScene& lit, std::initializer_list<glm::dvec3> corners,
                         std::vector<glm::dvec2> uvs = {{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}}) {
    Face face{{}, static_cast<std::uint32_t>(lit.scene.materials.size() - 1), 0, std::move(uvs)};
    for (const glm::dvec3& corner : corners) {
        face.vertices.push_back(static_cast<std::uint32_t>(lit.scene.positions.size()));
        lit.scene.positions.push_back(corner);
    }
    lit.scene.faces.push_back(face);
}

/// A lightmap of one row of texels.
inline void add_atlas(LitScene& lit, const std::vector<float>& irradiance) {
    const auto width = static_cast<std::uint32_t>(irradiance.size());
    lit.lightmaps.push_back({width, 1, {"Y"}, {irradiance}, std::vector<float>(width, 1.0f)});
}

/// One band.
inline LitScene scene_lit_by(const std::vector<float>& irradiance) {
    LitScene lit;
    lit.scene.file = "lit.glb";
    lit.scene.bands = {"Y"};
    lit.scene.objects = {"object"};
    add_atlas(lit, irradiance);
    return lit;
}

inline void add_material(LitScene& lit, double reflectance, double emission,
                         std::uint32_t atlas = 0) {
    lit.atlas_of.push_back(atlas);
    lit.scene.materials.push_back({"paint", {reflectance}, {emission}, false});
}

/// At z = `depth`, 20 x 20 m, faces the camera that looks along -z.
inline void add_wall(LitScene& lit, double depth) {
    add_triangle(lit, {{-10, -10, depth}, {10, -10, depth}, {10, 10, depth}});
    add_triangle(lit, {{-10, -10, depth}, {10, 10, depth}, {-10, 10, depth}});
}

}  // namespace hemirad
