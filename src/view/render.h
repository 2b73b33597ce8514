#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lightmap/lightmap.h"
#include "scene/camera.h"
#include "view/lit_scene.h"

namespace hemirad {

/// What of the light a picture holds.
enum class Shown { radiance, irradiance };

struct RenderSettings {
    std::uint32_t width = 800, height = 600;
    std::uint32_t samples = 3;  ///< rays a pixel, samples x samples
    Shown shown = Shown::radiance;
    std::string layer = {};  ///< of the lightmap; empty: the light of all
};

/// What the camera sees, each surface from its front: as radiance, W/(m^2 sr), with what lamps
/// emit unless of one layer; or what falls onto it, W/m^2. The lightmap is blended linearly between
/// four texels. The coverage is the part of a pixel that shows the scene; values are means over
/// that part. Throws InputError for a layer that the lightmap lacks, and for irradiance where it
/// holds radiosity.
Lightmap render(const LitScene& lit, const Camera& camera, const RenderSettings& settings);

}  // namespace hemirad
