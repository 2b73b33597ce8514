#include "view/render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <thread>

#include "errors.h"
#include "lightmap/atlas_file.h"
#include "scene/printable.h"
#include "view/first_hit.h"

namespace hemirad {
namespace {

using Bands = std::vector<std::vector<float>>;

const Bands& bands_of(const Lightmap& lightmap, const std::string& layer,
                      const std::filesystem::path& exr) {
    if (layer.empty()) return lightmap.values;
    const auto found = lightmap.layers.find(layer);
    if (found != lightmap.layers.end()) return found->second.values;
    std::string names;
    for (const auto& [name, values] : lightmap.layers) names += (names.empty() ? "" : ", ") + name;
    throw InputError(printable(exr.string()) + ": has no layer \"" + printable(layer) +
                     "\"; it has " + (names.empty() ? "none" : names));
}

/// By atlas.
std::vector<const Bands*> bands_of(const LitScene& lit, const std::string& layer) {
    std::vector<const Bands*> bands;
    for (std::uint32_t atlas = 0; atlas < lit.lightmaps.size(); ++atlas)
        bands.push_back(&bands_of(lit.lightmaps[atlas], layer, atlas_file(lit.exr, atlas)));
    return bands;
}

/// The four texels about a place, and their shares.
struct Blend {
    std::array<std::size_t, 4> texels;
    std::array<double, 4> shares;

    double of(const std::vector<float>& values) const {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += shares[i] * double{values[texels[i]]};
        return sum;
    }
};

Blend blend_at(const Lightmap& lightmap, const glm::dvec2& uv) {
    const auto along = [](double at, std::uint32_t size) {
        const double clamped = std::clamp(at * size - 0.5, 0.0, size - 1.0);
        const auto low = static_cast<std::size_t>(clamped);
        return std::tuple(low, std::min<std::size_t>(low + 1, size - 1), clamped - double(low));
    };
    const auto [left, right, u] = along(uv.x, lightmap.width);
    const auto [top, bottom, v] = along(uv.y, lightmap.height);
    const std::size_t width = lightmap.width;
    return {
        {top * width + left, top * width + right, bottom * width + left, bottom * width + right},
        {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

/// Directions of a camera's rays, by place in the picture: from (0, 0), top left.
struct Rays {
    glm::dvec3 eye, to_corner, to_right, to_below;

    glm::dvec3 at(double x, double y) const { return to_corner + x * to_right + y * to_below; }
};

Rays rays_of(const Camera& camera, const RenderSettings& settings) {
    const double half_height = std::tan(camera.yfov / 2);
    const double half_width = half_height * settings.width / settings.height;
    const glm::dvec3 right = glm::cross(camera.forward, camera.up);
    return {camera.eye, camera.forward - half_width * right + half_height * camera.up,
            2 * half_width * right, -2 * half_height * camera.up};
}

class Renderer {
  public:
    Renderer(const LitScene& lit, const Camera& camera, const RenderSettings& settings)
        : lit_(lit),
          settings_(settings),
          bands_(bands_of(lit, settings.layer)),
          rays_(rays_of(camera, settings)),
          first_hit_(lit.scene) {
        picture_ = {settings.width, settings.height, lit.scene.bands, {}, {}};
        picture_.values.assign(lit.scene.bands.size(), std::vector<float>(picture_.texel_count()));
        picture_.coverage.resize(picture_.texel_count());
    }

    /// Rows are shared out; each pixel has one writer.
    Lightmap run() {
        std::atomic<std::uint32_t> next = 0;
        std::vector<std::jthread> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
            threads.emplace_back([&] {
                for (std::uint32_t y = next++; y < settings_.height; y = next++) render_row(y);
            });
        threads.clear();
        return std::move(picture_);
    }

  private:
    void render_row(std::uint32_t y) {
        for (std::uint32_t x = 0; x < settings_.width; ++x) render_pixel(x, y);
    }

    void render_pixel(std::uint32_t x, std::uint32_t y) {
        const std::uint32_t n = settings_.samples;
        std::vector<double> sums(picture_.bands.size());
        std::uint32_t hits = 0;
        for (std::uint32_t i = 0; i < n * n; ++i) {
            const double at_x = (x + (i % n + 0.5) / n) / settings_.width;
            const double at_y = (y + (i / n + 0.5) / n) / settings_.height;
            if (const auto hit = first_hit_(rays_.eye, rays_.at(at_x, at_y))) {
                add(*hit, sums);
                ++hits;
            }
        }
        const std::size_t pixel = std::size_t{y} * settings_.width + x;
        picture_.coverage[pixel] = static_cast<float>(hits) / static_cast<float>(n * n);
        for (std::size_t band = 0; band < sums.size() && hits > 0; ++band)
            picture_.values[band][pixel] = static_cast<float>(sums[band] / hits);
    }

    void add(const FirstHit::Hit& hit, std::vector<double>& sums) const {
        const Face& face = lit_.scene.faces[hit.face];
        const Material& material = lit_.scene.materials[face.material];
        glm::dvec2 uv(0);
        for (int i = 0; i < 3; ++i) uv += hit.weights[i] * face.lightmap_uvs[std::size_t(i)];
        const std::uint32_t atlas = lit_.atlas_of[face.material];
        const Blend blend = blend_at(lit_.lightmaps[atlas], uv);
        for (std::size_t band = 0; band < sums.size(); ++band)
            sums[band] += seen(blend.of((*bands_[atlas])[band]), material, band);
    }

    double seen(double light, const Material& material, std::size_t band) const {
        if (settings_.shown == Shown::irradiance) return light;
        if (lit_.quantity == Quantity::radiosity) return light / std::numbers::pi;
        const double reflected = material.reflectance[band] * light / std::numbers::pi;
        return settings_.layer.empty() ? reflected + material.emission[band] : reflected;
    }

    const LitScene& lit_;
    const RenderSettings& settings_;
    std::vector<const Bands*> bands_;  ///< by atlas
    Rays rays_;
    FirstHit first_hit_;
    Lightmap picture_;
};

}  // namespace

Lightmap render(const LitScene& lit, const Camera& camera, const RenderSettings& settings) {
    if (settings.shown == Shown::irradiance && lit.quantity == Quantity::radiosity)
        throw InputError(printable(lit.exr.string()) +
                         ": holds radiosity; false colours need irradiance, as solve writes by "
                         "itself");
    return Renderer(lit, camera, settings).run();
}

}  // namespace hemirad
