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

/// As much as generated charts get at the default.
constexpr std::uint32_t kLargestSide = 8192;

/// Each is a file of its own, for which the scene is looked through: a thousand take some ten
/// seconds.
constexpr std::size_t kMostAtlases = 1024;

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

/// How full a texel is, and of what the most.
struct Claim {
    float filled = 0;
    std::uint32_t by = kNobody;  ///< in ChartLayout::authored
};

/// Of an atlas, whose texels are numbered row by row. Squares of them that nobody claims take no
/// memory: an atlas may be next to empty, and large for that very reason.
class Claims {
  public:
    explicit Claims(std::size_t side)
        : side_(side), across_(side / kSquare + 1), squares_(across_ * across_) {}

    Claim& operator[](std::size_t texel) {
        auto& square = squares_[square_of(texel)];
        if (square.empty()) square.resize(kSquare * kSquare);
        return square[place_of(texel)];
    }
    Claim at(std::size_t texel) const {
        const auto& square = squares_[square_of(texel)];
        return square.empty() ? Claim{} : square[place_of(texel)];
    }

  private:
    static constexpr std::size_t kSquare = 16;

    std::size_t square_of(std::size_t texel) const {
        return texel / side_ / kSquare * across_ + texel % side_ / kSquare;
    }
    std::size_t place_of(std::size_t texel) const {
        return texel / side_ % kSquare * kSquare + texel % side_ % kSquare;
    }

    std::size_t side_, across_;
    std::vector<std::vector<Claim>> squares_;
};

bool is_authored(const Scene& scene, const FaceTriangle& triangle, ChartSource source) {
    return source == ChartSource::authored && !scene.faces[triangle.face].lightmap_uvs.empty();
}

class Placer {
  public:
    Placer(const Scene& scene, const Mesh& mesh, const ChartSettings& settings, ChartLayout& layout)
        : scene_(scene), mesh_(mesh), settings_(settings), layout_(layout) {}

    void run() {
        collect();
        leave_out_flat_objects();
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

    /// At the largest side that there may be. Corners are still UVs.
    bool has_area(const AuthoredTriangle& triangle) const {
        const double side = settings_.atlas_size > 0 ? settings_.atlas_size : kLargestSide;
        return std::abs(signed_area(triangle.texels)) * side * side >= kNoArea;
    }

    /// Some exporters write TEXCOORD_1 of 0 where there is none: such objects have no UVs.
    void leave_out_flat_objects() {
        std::vector<bool> shown(scene_.objects.size());
        for (const AuthoredTriangle& triangle : layout_.authored)
            if (has_area(triangle)) shown[object_of(triangle)] = true;
        std::set<std::uint32_t> left_out;
        std::erase_if(layout_.authored, [&](const AuthoredTriangle& triangle) {
            const std::uint32_t object = object_of(triangle);
            if (!shown[object]) left_out.insert(object);
            return !shown[object];
        });
        if (left_out.empty()) return;
        layout_.warnings.push_back(names_of(left_out) +
                                   ": TEXCOORD_1 are without area, charts are generated");
    }

    /// A power of two, so that the mean texel is no larger than asked for.
    std::uint32_t side_for_texel_size() const {
        double area = 0, in_atlas = 0;
        for (const AuthoredTriangle& triangle : layout_.authored) {
            if (!has_area(triangle)) continue;
            area += std::abs(signed_area(triangle.at));
            in_atlas += std::abs(signed_area(triangle.texels));
        }
        const double side = std::sqrt(area / in_atlas) / layout_.texel_size;
        return std::bit_ceil(
            static_cast<std::uint32_t>(std::clamp(std::ceil(side), 1.0, double{kLargestSide})));
    }

    std::uint32_t object_of(const AuthoredTriangle& authored) const {
        return scene_.faces[mesh_.face_triangles[authored.face_triangle].face].object;
    }

    std::uint32_t object_of(std::uint32_t authored) const {
        return object_of(layout_.authored[authored]);
    }

    void place_objects() {
        std::vector<std::vector<std::uint32_t>> by_object(scene_.objects.size());
        for (std::uint32_t i = 0; i < layout_.authored.size(); ++i)
            by_object[object_of(i)].push_back(i);
        Claims own(side_);
        for (const auto& triangles : by_object) {
            if (triangles.empty()) continue;
            const auto texels = claim(triangles, own);
            const std::uint32_t atlas = free_atlas(object_of(triangles.front()), texels, own);
            for (const std::uint32_t i : triangles) layout_.authored[i].atlas = atlas;
            hand_over(texels, own, atlases_[atlas]);
        }
    }

    /// Which texels the triangles of an object claim.
    std::vector<std::size_t> claim(const std::vector<std::uint32_t>& triangles, Claims& own) {
        std::vector<std::size_t> texels;
        std::vector<TexelArea> areas;
        for (const std::uint32_t i : triangles) {
            TexelPolygon polygon;
            for (const glm::dvec2& corner : layout_.authored[i].texels) polygon.add(corner);
            find_texel_areas(polygon, {0, 0, side_, side_}, areas);
            for (const auto& [x, y, area] : areas) {
                if (area <= 0) continue;
                const std::size_t texel = std::size_t{y} * side_ + x;
                Claim& claim = own[texel];
                if (claim.filled == 0) texels.push_back(texel);
                if (claim.by == kNobody) claim.by = i;
                claim.filled += static_cast<float>(area);
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
            float& filled = own[texel].filled;
            claimed += filled;
            if (filled <= 1 + kOverlapSlack) continue;
            if (twice == 0) first = texel;
            twice += filled - 1;
            filled = 1;
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
                return atlases_[atlas].at(texel).filled + own.at(texel).filled > 1 + kOverlapSlack;
            });
            if (taken == texels.end()) {
                if (atlas > 0) warn_of_atlas(object, in_the_way, atlas);
                return atlas;
            }
            if (atlas == 0) in_the_way = object_of(atlases_[0].at(*taken).by);
        }
        check_count(object);
        atlases_.emplace_back(side_);
        const auto atlas = static_cast<std::uint32_t>(atlases_.size() - 1);
        if (atlas > 0) warn_of_atlas(object, in_the_way, atlas);
        return atlas;
    }

    /// Whether there may be one more.
    void check_count(std::uint32_t object) const {
        const auto most_of_side = static_cast<std::size_t>(kMostTexels / (1.0 * side_ * side_));
        if (atlases_.size() < std::min(kMostAtlases, most_of_side)) return;
        throw InputError(name_of(object) + ": its TEXCOORD_1 claim texels of objects in each of " +
                         std::to_string(atlases_.size()) + " lightmaps of " +
                         size_text(side_, side_) + " texels, the most there may be" +
                         (most_of_side < kMostAtlases ? ", a smaller --atlas-size aside" : "") +
                         kAdvice);
    }

    void warn_of_atlas(std::uint32_t object, std::uint32_t other, std::uint32_t atlas) {
        layout_.moved.push_back(name_of(object) + ": its TEXCOORD_1 claim texels of \"" +
                                scene_.objects[other] + "\": it goes to lightmap " +
                                std::to_string(atlas));
    }

    static void hand_over(const std::vector<std::size_t>& texels, Claims& own, Claims& atlas) {
        for (const std::size_t texel : texels) {
            Claim& claim = atlas[texel];
            claim.filled += own[texel].filled;
            if (claim.by == kNobody) claim.by = own[texel].by;
            own[texel] = {};
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
        layout_.warnings.push_back(names_of(objects) + ": " + std::to_string(count) +
                                   (count == 1 ? " triangle is " : " triangles are ") + what);
    }

    std::string names_of(const std::set<std::uint32_t>& objects) const {
        return names_in_short(objects.size(), 1,
                              [&](std::size_t) { return name_of(*objects.begin()); });
    }

    const Scene& scene_;
    const Mesh& mesh_;
    const ChartSettings& settings_;
    ChartLayout& layout_;
    std::uint32_t side_ = 0;
    std::vector<Claims> atlases_;
};

}  // namespace

void place_authored(const Scene& scene, const Mesh& mesh, const ChartSettings& settings,
                    ChartLayout& layout) {
    Placer(scene, mesh, settings, layout).run();
}

}  // namespace hemirad
