#include "lightmap/authored_charts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <set>

#include "errors.h"
#include "lightmap/texel_areas.h"
#include "scene/short_text.h"

namespace hemirad {
namespace {

/// What UVs in floats, in an atlas of 16384 texels, may seem to overlap by: some thousandths of a
/// texel a side.
constexpr double kOverlapSlack = 0.01;

/// Blender's Smart UV Project lays 0.1 % of its own Suzanne onto another part of her; what is
/// mapped for textures alone overlaps by tens of percent.
constexpr double kMostOverlap = 0.01;

/// Exporters write floats of what they clamped to [0, 1] in other units.
constexpr double kRangeSlack = 1e-5;

/// Smaller, in texels, no texel's value depends on it.
constexpr double kNoArea = 1e-6;

constexpr std::uint32_t kNobody = 0xffffffffu;

constexpr const char* kAdvice = "; --charts generated ignores the scene's and lays out new ones";

using Corners = std::array<glm::dvec2, 3>;

double signed_area(const Corners& corners) {
    const glm::dvec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
    return (a.x * b.y - a.y * b.x) / 2;
}

std::string text_of(const glm::dvec2& uv) {
    char text[64];
    std::snprintf(text, sizeof text, "(%.4g, %.4g)", uv.x, uv.y);
    return text;
}

/// How full each texel of an atlas is, and of what the most.
struct Claims {
    std::vector<float> filled;
    std::vector<std::uint32_t> by;  ///< in ChartLayout::authored

    explicit Claims(std::size_t texels) : filled(texels, 0.0f), by(texels, kNobody) {}
};

class Placer {
  public:
    Placer(const Scene& scene, const Mesh& mesh, const ChartSettings& settings, ChartLayout& layout)
        : scene_(scene), mesh_(mesh), settings_(settings), layout_(layout) {}

    void run() {
        collect();
        if (layout_.authored.empty()) return;
        side_ = settings_.atlas_size > 0 ? settings_.atlas_size : side_for_texel_size();
        for (AuthoredTriangle& triangle : layout_.authored)
            for (glm::dvec2& corner : triangle.texels) corner *= side_;
        place_objects();
        for (std::size_t i = 0; i < atlases_.size(); ++i) layout_.atlases.push_back({side_, side_});
        warn_of_shapes();
    }

  private:
    void collect() {
        for (std::uint32_t i = 0; i < mesh_.face_triangles.size(); ++i) {
            const FaceTriangle& triangle = mesh_.face_triangles[i];
            if (!is_authored(scene_, triangle, settings_.source)) continue;
            const Surface& surface = mesh_.surfaces[triangle.surface];
            const Face& face = scene_.faces[triangle.face];
            AuthoredTriangle authored{i, 0, {}, {}};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t corner = triangle.corners[k];
                const glm::dvec3 offset = scene_.positions[face.vertices[corner]] - surface.origin;
                authored.texels[k] = checked(face.lightmap_uvs[corner], face.object);
                authored.at[k] = {glm::dot(offset, surface.u_axis),
                                  glm::dot(offset, surface.v_axis)};
            }
            layout_.authored.push_back(authored);
        }
    }

    std::string name_of(std::uint32_t object) const {
        return scene_.file + ": \"" + scene_.objects[object] + "\"";
    }

    glm::dvec2 checked(const glm::dvec2& uv, std::uint32_t object) const {
        if (uv.x < -kRangeSlack || uv.x > 1 + kRangeSlack || uv.y < -kRangeSlack ||
            uv.y > 1 + kRangeSlack)
            throw InputError(name_of(object) + ": TEXCOORD_1 " + text_of(uv) +
                             " is outside of 0 to 1, where a lightmap has texels" + kAdvice);
        const glm::dvec2 inside = glm::clamp(uv, 0.0, 1.0);
        return settings_.flip_v ? glm::dvec2(inside.x, 1 - inside.y) : inside;
    }

    /// A power of two, so that the mean texel is no larger than asked for.
    std::uint32_t side_for_texel_size() const {
        constexpr double kLargest = 8192;  // as much as generated charts get at the default
        double area = 0, in_atlas = 0;
        for (const AuthoredTriangle& triangle : layout_.authored) {
            area += std::abs(signed_area(triangle.at));
            in_atlas += std::abs(signed_area(triangle.texels));
        }
        const double side = std::sqrt(area / std::max(in_atlas, 1e-12)) / layout_.texel_size;
        return std::bit_ceil(
            static_cast<std::uint32_t>(std::clamp(std::ceil(side), 1.0, kLargest)));
    }

    std::uint32_t object_of(std::uint32_t authored) const {
        const auto& triangle = mesh_.face_triangles[layout_.authored[authored].face_triangle];
        return scene_.faces[triangle.face].object;
    }

    void place_objects() {
        std::vector<std::vector<std::uint32_t>> by_object(scene_.objects.size());
        for (std::uint32_t i = 0; i < layout_.authored.size(); ++i)
            by_object[object_of(i)].push_back(i);
        Claims own(texel_count());
        for (const auto& triangles : by_object) {
            if (triangles.empty()) continue;
            const auto texels = claim(triangles, own);
            const std::uint32_t atlas = free_atlas(object_of(triangles.front()), texels, own);
            for (const std::uint32_t i : triangles) layout_.authored[i].atlas = atlas;
            hand_over(texels, own, atlases_[atlas]);
        }
    }

    std::size_t texel_count() const { return std::size_t{side_} * side_; }

    /// Which texels the triangles of an object claim.
    std::vector<std::size_t> claim(const std::vector<std::uint32_t>& triangles, Claims& own) {
        std::vector<std::size_t> texels;
        std::vector<TexelArea> areas;
        for (const std::uint32_t i : triangles) {
            TexelPolygon polygon;
            for (const glm::dvec2& corner : layout_.authored[i].texels) polygon.add(corner);
            find_texel_areas(polygon, {0, 0, side_, side_}, areas);
            for (const auto& [x, y, area] : areas) {
                const std::size_t texel = std::size_t{y} * side_ + x;
                if (area <= 0) continue;
                if (own.filled[texel] == 0) texels.push_back(texel);
                if (own.by[texel] == kNobody) own.by[texel] = i;
                own.filled[texel] += static_cast<float>(area);
            }
        }
        settle_overlaps(object_of(triangles.front()), texels, own);
        return texels;
    }

    /// Texels that are claimed twice are told of, or too many.
    void settle_overlaps(std::uint32_t object, const std::vector<std::size_t>& texels,
                         Claims& own) {
        double claimed = 0, twice = 0;
        std::size_t first = 0;
        for (const std::size_t texel : texels) {
            claimed += own.filled[texel];
            if (own.filled[texel] <= 1 + kOverlapSlack) continue;
            if (twice == 0) first = texel;
            twice += own.filled[texel] - 1;
            own.filled[texel] = 1;
        }
        if (twice > kMostOverlap * claimed) refuse(object, first);
        if (twice > 0) warn_of_overlap(object, twice / claimed, first);
    }

    std::string place_of(std::size_t texel) const {
        const glm::dvec2 uv = glm::dvec2(texel % side_ + 0.5, texel / side_ + 0.5) / double(side_);
        return text_of(settings_.flip_v ? glm::dvec2(uv.x, 1 - uv.y) : uv);
    }

    void warn_of_overlap(std::uint32_t object, double share, std::size_t texel) {
        char percent[32];
        std::snprintf(percent, sizeof percent, "%.2g %%", 100 * share);
        layout_.warnings.push_back(name_of(object) + ": " + percent +
                                   " of its triangles' area overlaps in TEXCOORD_1, as at " +
                                   place_of(texel) + ": a texel there shows one place of two");
    }

    [[noreturn]] void refuse(std::uint32_t object, std::size_t texel) const {
        throw InputError(name_of(object) + ": its triangles overlap in TEXCOORD_1, as at " +
                         place_of(texel) + ": a texel cannot hold the light of two places" +
                         kAdvice);
    }

    /// The first in which the object shares no texel, and a warning where that is not the first.
    std::uint32_t free_atlas(std::uint32_t object, const std::vector<std::size_t>& texels,
                             const Claims& own) {
        std::uint32_t in_the_way = kNobody;
        for (std::uint32_t atlas = 0; atlas < atlases_.size(); ++atlas) {
            const auto taken = std::ranges::find_if(texels, [&](std::size_t texel) {
                return atlases_[atlas].filled[texel] + own.filled[texel] > 1 + kOverlapSlack;
            });
            if (taken == texels.end()) {
                if (atlas > 0) warn_of_atlas(object, in_the_way, atlas);
                return atlas;
            }
            if (atlas == 0) in_the_way = object_of(atlases_[0].by[*taken]);
        }
        atlases_.emplace_back(texel_count());
        const auto atlas = static_cast<std::uint32_t>(atlases_.size() - 1);
        if (atlas > 0) warn_of_atlas(object, in_the_way, atlas);
        return atlas;
    }

    void warn_of_atlas(std::uint32_t object, std::uint32_t other, std::uint32_t atlas) {
        layout_.moved.push_back(name_of(object) + ": its TEXCOORD_1 claim texels of \"" +
                                scene_.objects[other] + "\": it goes to lightmap " +
                                std::to_string(atlas));
    }

    static void hand_over(const std::vector<std::size_t>& texels, Claims& own, Claims& atlas) {
        for (const std::size_t texel : texels) {
            atlas.filled[texel] += own.filled[texel];
            if (atlas.by[texel] == kNobody) atlas.by[texel] = own.by[texel];
            own.filled[texel] = 0;
            own.by[texel] = kNobody;
        }
    }

    /// Seen from the front and with V running down, a triangle that is not mirrored turns against
    /// the axes.
    void warn_of_shapes() {
        std::set<std::uint32_t> mirrored_objects, flat_objects;
        std::size_t mirrored = 0, flat = 0;
        for (std::uint32_t i = 0; i < layout_.authored.size(); ++i) {
            const double area = signed_area(layout_.authored[i].texels);
            if (std::abs(area) < kNoArea) {
                ++flat;
                flat_objects.insert(object_of(i));
            } else if (area > 0) {
                ++mirrored;
                mirrored_objects.insert(object_of(i));
            }
        }
        if (mirrored == layout_.authored.size())
            warn_of(mirrored, mirrored_objects,
                    "mirrored in TEXCOORD_1, as all are: is V to run up (--flip-v)?");
        else
            warn_of(mirrored, mirrored_objects, "mirrored in TEXCOORD_1");
        warn_of(flat, flat_objects, "without area in TEXCOORD_1, no texel shows them");
    }

    void warn_of(std::size_t count, const std::set<std::uint32_t>& objects, const char* what) {
        if (count == 0) return;
        const auto names = names_in_short(objects.size(), 1,
                                          [&](std::size_t) { return name_of(*objects.begin()); });
        layout_.warnings.push_back(names + ": " + std::to_string(count) +
                                   (count == 1 ? " triangle is " : " triangles are ") + what);
    }

    const Scene& scene_;
    const Mesh& mesh_;
    const ChartSettings& settings_;
    ChartLayout& layout_;
    std::uint32_t side_ = 0;
    std::vector<Claims> atlases_;
};

}  // namespace

bool is_authored(const Scene& scene, const FaceTriangle& triangle, ChartSource source) {
    return source == ChartSource::authored && !scene.faces[triangle.face].lightmap_uvs.empty();
}

void place_authored(const Scene& scene, const Mesh& mesh, const ChartSettings& settings,
                    ChartLayout& layout) {
    Placer(scene, mesh, settings, layout).run();
}

}  // namespace hemirad
