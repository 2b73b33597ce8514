#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "cli/option_values.h"

namespace hemirad {

/// What main() runs once the command line is understood; returns the exit code.
using Command = std::function<int()>;

/// How an option appears in --help.
struct OptionText {
    std::string names;        ///< "-o,--output"
    std::string placeholder;  ///< "FILE.exr"
    std::string meaning;
};

/// An option with one value, given at most once; `read` stores or rejects it.
CLI::Option* add_value(CLI::App& command, const OptionText& text,
                       std::function<void(const OptionValue&)> read);

/// The same for values that are taken as they are: names of files.
template <class Text>
CLI::Option* add_text(CLI::App& command, const OptionText& text, Text& target) {
    return add_value(command, text, [&target](const OptionValue& value) {
        if (value.text.empty()) reject(value, "a name");
        target = Text(std::string(value.text));
    });
}

}  // namespace hemirad
