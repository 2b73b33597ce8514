#include "view/false_colour.h"

#include <gtest/gtest.h>

#include "view/picture_of.h"

namespace hemirad::false_colour_test {
namespace {

Lightmap row_of(const std::vector<float>& values) {
    const auto width = static_cast<std::uint32_t>(values.size());
    return {width, 1, {"R", "G", "B"}, {values, values, values}, std::vector<float>(width, 1.0f)};
}

std::array<int, 3> pixel(const Picture& picture, std::uint32_t x, std::uint32_t y) {
    const std::size_t at = 3 * (std::size_t{y} * picture.width + x);
    return {picture.pixels[at], picture.pixels[at + 1], picture.pixels[at + 2]};
}

double lightness(const Colour& colour) {
    return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
}

TEST(FalseColour, IsEverLighter) {
    for (double value = 0; value < 1; value += 0.01)
        EXPECT_GT(lightness(false_colour(value + 0.01)), lightness(false_colour(value)));
}

TEST(FalseColour, EndsWhereTheScaleEnds) {
    EXPECT_EQ(false_colour(-1), false_colour(0));
    EXPECT_EQ(false_colour(7), false_colour(1));
}

TEST(FalseColour, ScalesEndAtRoundNumbers) {
    EXPECT_DOUBLE_EQ(round_above(0.013), 0.015);
    EXPECT_DOUBLE_EQ(round_above(2.1), 2.5);
    EXPECT_DOUBLE_EQ(round_above(81), 100);
    EXPECT_DOUBLE_EQ(round_above(100), 100);
    EXPECT_DOUBLE_EQ(round_above(0), 1);
}

TEST(FalseColour, SpecksDoNotStretchAScale) {
    std::vector<double> values(200, 2.1);
    values[7] = 1e6;

    EXPECT_DOUBLE_EQ(scale_end(values), 2.5);
    EXPECT_DOUBLE_EQ(scale_end({}), 1);
}

TEST(FalseColours, TheSumOfTheBandsIsShown) {
    const Picture picture = false_colours_of(row_of(std::vector<float>(200, 1.0f)), 3.0, "W/m^2");
    const Picture half = false_colours_of(row_of(std::vector<float>(200, 0.5f)), 3.0, "W/m^2");

    EXPECT_EQ(pixel(picture, 100, 0), (std::array<int, 3>{252, 232, 36}));
    EXPECT_LT(pixel(half, 100, 0)[0], 60);
}

TEST(FalseColours, AScaleWithNumbersStandsBelow) {
    const Picture picture = false_colours_of(row_of(std::vector<float>(200, 1.0f)), 3.0, "W/m^2");

    ASSERT_GT(picture.height, 20u);
    int white = 0;
    for (std::uint32_t y = 24; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x)
            white += pixel(picture, x, y) == std::array<int, 3>{255, 255, 255};
    EXPECT_GT(white, 100);
    EXPECT_LT(pixel(picture, 13, 8)[1], 20);
    EXPECT_GT(pixel(picture, 186, 8)[1], 220);
}

TEST(FalseColours, FitOnTheSmallestPicture) {
    EXPECT_EQ(false_colours_of(row_of({1.0f}), {}, "W/m^2").width, 1u);
}

}  // namespace
}  // namespace hemirad::false_colour_test
