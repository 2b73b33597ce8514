#include "view/picture_of.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "lightmap/tone.h"
#include "view/false_colour.h"

#include <stb/stb_easy_font.h>

namespace hemirad {
namespace {

using Rgb = std::array<unsigned char, 3>;

constexpr std::uint32_t kWide = 400;  // pixels in which numbers of twice the font's size find room
constexpr std::uint32_t kLegendHeight = 62, kBarHeight = 14, kMargin = 12;

std::array<double, 3> shown_at(const Lightmap& rendered, std::size_t pixel) {
    const ShownBands shown = shown_bands(rendered.bands.size());
    return {rendered.values[shown[0]][pixel], rendered.values[shown[1]][pixel],
            rendered.values[shown[2]][pixel]};
}

double sum_at(const Lightmap& rendered, std::size_t pixel) {
    double sum = 0;
    for (const auto& band : rendered.values) sum += double{band[pixel]};
    return sum;
}

double largest_of(const Lightmap& rendered) {
    std::vector<double> sums;
    for (std::size_t pixel = 0; pixel < rendered.texel_count(); ++pixel)
        if (rendered.coverage[pixel] > 0) sums.push_back(sum_at(rendered, pixel));
    return scale_end(std::move(sums));
}

/// What a pixel shows beside its part of the scene is black.
Rgb pixel_of(const std::array<double, 3>& colour, double coverage) {
    Rgb pixel;
    for (std::size_t i = 0; i < 3; ++i)
        pixel[i] = static_cast<unsigned char>(
            std::lround(255 * std::clamp(colour[i] * coverage, 0.0, 1.0)));
    return pixel;
}

class Canvas {
  public:
    Canvas(std::uint32_t width, std::uint32_t height)
        : picture_{width, height, 3, std::vector<unsigned char>(std::size_t{3} * width * height)} {}

    void set(std::uint32_t x, std::uint32_t y, const Rgb& pixel) {
        if (x >= picture_.width || y >= picture_.height) return;
        std::copy(
            pixel.begin(), pixel.end(),
            picture_.pixels.begin() + std::ptrdiff_t(3 * (std::size_t{y} * picture_.width + x)));
    }

    /// stb's font consists of rectangles; the middle of the text at `x`, kept inside.
    void write(std::uint32_t x, std::uint32_t y, std::string text) {
        const auto width = scale_ * static_cast<std::uint32_t>(stb_easy_font_width(text.data()));
        const std::uint32_t room = picture_.width > width + 2 ? picture_.width - width - 2 : 0;
        const std::uint32_t left = std::min(x > width / 2 ? x - width / 2 : 0, room);
        std::vector<char> quads(300 * text.size() + 300);
        const int count =
            stb_easy_font_print(0, 0, text.data(), nullptr, quads.data(), int(quads.size()));
        for (int i = 0; i < count; ++i) fill(left, y, quads.data() + std::ptrdiff_t{64} * i);
    }

    Picture picture() && { return std::move(picture_); }

  private:
    /// Four vertices of 16 bytes: x, y, z, colour; the first and the third are opposite.
    void fill(std::uint32_t left, std::uint32_t top, const char* quad) {
        float low[2], high[2];
        std::memcpy(low, quad, sizeof low);
        std::memcpy(high, quad + 32, sizeof high);
        const auto scaled = [&](float at) { return scale_ * static_cast<std::uint32_t>(at); };
        for (auto y = scaled(low[1]); y < scaled(high[1]); ++y)
            for (auto x = scaled(low[0]); x < scaled(high[0]); ++x)
                set(left + x, top + y, {255, 255, 255});
    }

    Picture picture_;
    std::uint32_t scale_ = picture_.width < kWide ? 1 : 2;  ///< of letters
};

std::string tick_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

void draw_legend(Canvas& canvas, const Lightmap& rendered, double largest,
                 const std::string& unit) {
    constexpr int kTicks = 5;
    const std::uint32_t top = rendered.height;
    const std::uint32_t length = std::max(rendered.width, 2 * kMargin + 2) - 2 * kMargin;
    for (std::uint32_t x = 0; x < length; ++x)
        for (std::uint32_t y = 4; y < 4 + kBarHeight; ++y)
            canvas.set(kMargin + x, top + y, pixel_of(false_colour((x + 0.5) / length), 1));
    for (int tick = 0; tick <= kTicks; ++tick) {
        const auto x = kMargin + static_cast<std::uint32_t>(double(length - 1) * tick / kTicks);
        for (std::uint32_t y = 0; y < 4; ++y)
            canvas.set(x, top + 4 + kBarHeight + y, {255, 255, 255});
        canvas.write(x, top + 4 + kBarHeight + 6, tick_text(largest * tick / kTicks));
    }
    canvas.write(rendered.width / 2, top + 4 + kBarHeight + 24, unit);
}

}  // namespace

double automatic_exposure(const Lightmap& rendered) {
    std::vector<double> luminances;
    for (std::size_t pixel = 0; pixel < rendered.texel_count(); ++pixel) {
        const auto [red, green, blue] = shown_at(rendered, pixel);
        if (rendered.coverage[pixel] > 0) luminances.push_back(luminance(red, green, blue));
    }
    return exposure_for(std::move(luminances));
}

Picture picture_of(const Lightmap& rendered, double exposure) {
    Picture picture{rendered.width, rendered.height, 3, {}};
    picture.pixels.reserve(3 * rendered.texel_count());
    for (std::size_t pixel = 0; pixel < rendered.texel_count(); ++pixel)
        for (const double value : shown_at(rendered, pixel))
            picture.pixels.push_back(film_pixel(value * rendered.coverage[pixel], exposure));
    return picture;
}

Picture false_colours_of(const Lightmap& rendered, std::optional<double> largest,
                         const std::string& unit) {
    const double end = largest ? *largest : largest_of(rendered);
    Canvas canvas(rendered.width, rendered.height + kLegendHeight);
    for (std::size_t pixel = 0; pixel < rendered.texel_count(); ++pixel)
        canvas.set(static_cast<std::uint32_t>(pixel % rendered.width),
                   static_cast<std::uint32_t>(pixel / rendered.width),
                   pixel_of(false_colour(sum_at(rendered, pixel) / end),
                            double{rendered.coverage[pixel]}));
    draw_legend(canvas, rendered, end, unit);
    return std::move(canvas).picture();
}

}  // namespace hemirad
