#include "lightmap/write_preview.h"

#include <memory>

#include "errors.h"
#include "lightmap/support.h"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

namespace hemirad::write_preview_test {
namespace {

class WritePreview : public InFolder {};

struct Png {
    int width = 0, height = 0, channel_count = 0;
    std::vector<unsigned char> pixels;
};

Png read_png(const std::filesystem::path& path) {
    Png png;
    const std::unique_ptr<unsigned char, void (*)(void*)> pixels(
        stbi_load(path.c_str(), &png.width, &png.height, &png.channel_count, 0), stbi_image_free);
    if (pixels) {
        png.pixels.assign(pixels.get(), pixels.get() + png.width * png.height * png.channel_count);
    }
    return png;
}

/// One row, every texel covered, `values` by band.
Lightmap row_of(const std::vector<std::vector<float>>& values) {
    const auto width = static_cast<std::uint32_t>(values[0].size());
    return {width, 1, std::vector<std::string>(values.size(), "band"), values,
            std::vector<float>(width, 1.0f)};
}

TEST_F(WritePreview, ThreeBandsOpenAsAnRgbPictureOfTheRightSize) {
    write_preview(file("a.png"), numbered_lightmap(19, 7, {"R", "G", "B"}));

    const Png png = read_png(file("a.png"));
    EXPECT_EQ(png.width, 19);
    EXPECT_EQ(png.height, 7);
    EXPECT_EQ(png.channel_count, 3);
}

TEST_F(WritePreview, OneBandIsGrey) {
    write_preview(file("a.png"), row_of({{0.0f, 1.0f, 1.0f}}));

    const Png png = read_png(file("a.png"));
    EXPECT_EQ(png.channel_count, 1);
    EXPECT_EQ(png.pixels[0], 0);
    EXPECT_EQ(png.pixels[1], 231);  // sRGB of 0.8
}

TEST_F(WritePreview, ThePictureDoesNotDependOnTheUnit) {
    write_preview(file("a.png"), row_of({{0.1f, 0.5f, 1.0f, 2.0f}}));
    write_preview(file("b.png"), row_of({{100.0f, 500.0f, 1000.0f, 2000.0f}}));

    EXPECT_EQ(read_png(file("a.png")).pixels, read_png(file("b.png")).pixels);
}

TEST_F(WritePreview, OfManyBandsTheLastIsRedTheMiddleGreenTheFirstBlue) {
    write_preview(file("a.png"), row_of({{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {9, 9, 9}, {0, 0, 1}}));

    const auto pixels = read_png(file("a.png")).pixels;
    const auto is_lit = [&](std::size_t i) { return pixels[i] > 0; };
    EXPECT_TRUE(!is_lit(0) && !is_lit(1) && is_lit(2));
    EXPECT_TRUE(!is_lit(3) && is_lit(4) && !is_lit(5));
    EXPECT_TRUE(is_lit(6) && !is_lit(7) && !is_lit(8));
}

TEST_F(WritePreview, DarknessIsBlack) {
    write_preview(file("a.png"), row_of({{0.0f, 0.0f}}));

    EXPECT_EQ(read_png(file("a.png")).pixels, (std::vector<unsigned char>{0, 0}));
}

TEST_F(WritePreview, AFullDiskIsTold) {
    const auto message = message_of<OutputError>([&] {
        write_preview("/dev/full", numbered_lightmap(9, 9, {"R", "G", "B"}));
    });

    EXPECT_EQ(message, "/dev/full: No space left on device");
}

}  // namespace
}  // namespace hemirad::write_preview_test
