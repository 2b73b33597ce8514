#pragma once

#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>

#include "scene/input_file.h"

namespace hemirad {

/// A line of a text file, for messages.
struct InputLine {
    const InputFile& file;
    std::size_t number;  ///< from 1

    /// Throws the InputError `FILE: line N: REASON`.
    [[noreturn]] void fail(const std::string& reason) const {
        hemirad::fail(file, "line " + std::to_string(number), reason);
    }
};

/// To the last bit, whatever the locale; the whole word has to be the number.
template <class Number>
Number read_number(const InputLine& line, std::string_view word) {
    if (word.empty()) line.fail("a number is missing");
    const std::string_view digits = word.substr(word.front() == '+' ? 1 : 0);
    Number value{};
    const auto [end, error] = std::from_chars(digits.begin(), digits.end(), value);
    if (error == std::errc::result_out_of_range) line.fail(in_quotes(word) + " is out of range");
    if (error != std::errc{} || end != digits.end()) line.fail(in_quotes(word) + " is no number");
    return value;
}

}  // namespace hemirad
