#pragma once

#include <array>
#include <span>
#include <vector>

namespace hemirad {

using Colour = std::array<double, 3>;  ///< sRGB, from 0 to 1

/// From dark blue to yellow, ever lighter, and told apart by those who see no red or no green:
/// after viridis (van der Walt and Smith 2015), straight between the colours given here.
std::span<const Colour> false_colours();

/// Of a value between 0 and 1; what lies outside has the colour of that end.
Colour false_colour(double value);

/// The least of 1, 1.5, 2, 2.5, 3, 4, 5, 6 and 8 times a power of ten that is not below the value.
double round_above(double value);

/// Where a scale ends that shows these values: a round number that nearly all are below, so that
/// specks do not stretch it; 1 where there are none.
double scale_end(std::vector<double> values);

}  // namespace hemirad
