#pragma once

#include <optional>
#include <string>

#include "lightmap/lightmap.h"
#include "lightmap/png.h"

namespace hemirad {

/// The exposure that picture_of() takes where it is given none: exposure_for() all pixels.
double automatic_exposure(const Lightmap& rendered);

/// Tone-mapped as the preview of a lightmap is; black where nothing is seen.
Picture picture_of(const Lightmap& rendered, double exposure);

/// The sum of the bands as colours, with a scale below that ends at `largest`; without that at a
/// round number above nearly all pixels. `unit` stands below the scale.
Picture false_colours_of(const Lightmap& rendered, std::optional<double> largest,
                         const std::string& unit);

}  // namespace hemirad
