#include "view/false_colour.h"

#include <algorithm>
#include <cmath>

namespace hemirad {
namespace {

constexpr std::array<Colour, 9> kColours{{{0.27, 0.00, 0.33},
                                          {0.28, 0.17, 0.48},
                                          {0.23, 0.32, 0.55},
                                          {0.17, 0.44, 0.56},
                                          {0.13, 0.57, 0.55},
                                          {0.15, 0.68, 0.51},
                                          {0.36, 0.79, 0.39},
                                          {0.67, 0.86, 0.19},
                                          {0.99, 0.91, 0.14}}};

}  // namespace

std::span<const Colour> false_colours() { return kColours; }

Colour false_colour(double value) {
    const double at = std::clamp(value, 0.0, 1.0) * (kColours.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), kColours.size() - 2);
    const double part = at - double(low);
    Colour colour;
    for (std::size_t i = 0; i < colour.size(); ++i)
        colour[i] = std::lerp(kColours[low][i], kColours[low + 1][i], part);
    return colour;
}

double round_above(double value) {
    if (!(value > 0)) return 1;
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double step : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
        if (step * power >= value) return step * power;
    return 10 * power;
}

double scale_end(std::vector<double> values) {
    constexpr double kNearlyAll = 0.99;
    if (values.empty()) return 1;
    const auto rank = static_cast<std::ptrdiff_t>(kNearlyAll * double(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return round_above(values[static_cast<std::size_t>(rank)]);
}

}  // namespace hemirad
