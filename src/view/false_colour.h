#pragma once

#include <array>
#include <span>

namespace hemirad {

using Colour = std::array<double, 3>;  ///< sRGB, from 0 to 1

/// From dark blue to yellow, ever lighter, and told apart by those who see no red or no green:
/// after viridis (van der Walt and Smith 2015), straight between the colours given here.
std::span<const Colour> false_colours();

/// Of a value between 0 and 1; what lies outside has the colour of that end.
Colour false_colour(double value);

/// The least of 1, 1.5, 2, 2.5, 3, 4, 5, 6 and 8 times a power of ten that is not below the value.
double round_above(double value);

}  // namespace hemirad
