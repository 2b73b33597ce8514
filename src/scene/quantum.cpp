#include "scene/quantum.h"

#include <array>
#include <charconv>
#include <cmath>

namespace hemirad {
namespace {

/// Half a unit of the last decimal of a number that has been read: 1.250e-3 is good to 5e-7.
double half_last_place(std::string_view word) {
    const auto exponent_at = std::min(word.find_first_of("eE"), word.size());
    const auto point_at = std::min(word.find('.'), exponent_at);
    const auto decimals = exponent_at - std::min(point_at + 1, exponent_at);
    int exponent = 0;
    if (exponent_at < word.size()) {
        std::string_view digits = word.substr(exponent_at + 1);
        if (digits.starts_with('+')) digits.remove_prefix(1);
        std::from_chars(digits.begin(), digits.end(), exponent);
    }
    return 0.5 * std::pow(10.0, double(exponent) - double(decimals));
}

bool is_float(double value) { return double(float(value)) == value; }

}  // namespace

bool is_float_in_full(double value) {
    if (!is_float(value)) return false;
    std::array<char, 32> text{};
    // Shortest that reads back as the same double: d.ddde+xx.
    const auto end = std::to_chars(text.data(), text.data() + text.size(), std::abs(value),
                                   std::chars_format::scientific);
    const std::string_view digits(text.data(), std::size_t(end.ptr - text.data()));
    return digits.find('e') > 10;  // nine digits and a point
}

void TextQuantum::add(std::string_view word, double value) {
    of_floats_ = std::max(of_floats_, half_float_ulp(value));
    constexpr double kChosen = 5e-4;
    of_decimals_ =
        std::max(of_decimals_, std::min({half_last_place(word), half_float_ulp(value), kChosen}));
    all_floats_ = all_floats_ && is_float(value);
    any_in_full_ = any_in_full_ || is_float_in_full(value);
}

void TextQuantum::add(const TextQuantum& other) {
    of_floats_ = std::max(of_floats_, other.of_floats_);
    of_decimals_ = std::max(of_decimals_, other.of_decimals_);
    all_floats_ = all_floats_ && other.all_floats_;
    any_in_full_ = any_in_full_ || other.any_in_full_;
}

}  // namespace hemirad
