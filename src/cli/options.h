#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/option_values.h"

// CLI/CLI.hpp costs each file that reads it seconds to compile: it stays behind these functions.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace hemirad {

/// What main() runs once the command line is understood; returns the exit code.
using Command = std::function<int()>;

CLI::App& add_command(CLI::App& app, const std::string& name, const std::string& meaning);

/// Called when all of the command line is understood.
void on_chosen(CLI::App& command, std::function<void()> choose);

/// Called before that, when the arguments after the command's name are understood.
void on_understood(CLI::App& command, std::function<void()> conclude);

/// Under which heading --help lists the options that are added from here on.
void begin_group(CLI::App& command, const std::string& heading);

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

/// Given any number of times, a name each time.
CLI::Option* add_names(CLI::App& command, const OptionText& text, std::vector<std::string>& names);

/// Arguments without an option's name, any number of them.
CLI::Option* add_files(CLI::App& command, const OptionText& text, std::vector<std::string>& files);

CLI::Option* add_flag(CLI::App& command, const std::string& names, bool& flag,
                      const std::string& meaning);
CLI::Option* add_flag(CLI::App& command, const std::string& names, std::function<void()> set,
                      const std::string& meaning);

void require(CLI::Option* option);
void let_stand_alone(CLI::Option* option);  ///< its value may be missing; it is "" then
void exclude(CLI::Option* option, CLI::Option* other);
void need(CLI::App& command, CLI::Option* option, const std::string& other);
bool is_given(const CLI::Option* option);

/// What --help says of an option in place of what it said so far.
void describe(CLI::App& command, const std::string& option, const std::string& meaning);

/// Stops as for two options that exclude each other.
[[noreturn]] void reject_both(const std::string& option, const std::string& other);

}  // namespace hemirad
