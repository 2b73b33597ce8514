#pragma once

#include <algorithm>
#include <string_view>

namespace hemirad {

/// Half a float ulp of a number of this size, at most.
constexpr double half_float_ulp(double value) { return 0x1p-24 * (value < 0 ? -value : value); }

/// A float written to its last digit: needs more than the nine digits that tell floats apart. So
/// do not 0.1, which no float is, nor 1000, which was chosen.
bool is_float_in_full(double value);

/// What the coordinates of a text were rounded to at most: each half a unit of its last decimal, if
/// that is less than half a float ulp, and no more than half a millimetre: 4500000.0 m was chosen,
/// and the walls of a house there are thinner than decimetres. A text of many decimals may carry
/// floats in full nonetheless.
class TextQuantum {
  public:
    void add(std::string_view word, double value);
    void add(const TextQuantum& other);
    double value() const { return all_floats_ && any_in_full_ ? of_floats_ : of_decimals_; }

  private:
    double of_decimals_ = 0, of_floats_ = 0;
    bool all_floats_ = true, any_in_full_ = false;
};

}  // namespace hemirad
