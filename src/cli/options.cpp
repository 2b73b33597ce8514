#include "cli/options.h"

#include <CLI/CLI.hpp>

namespace hemirad {

CLI::App& add_command(CLI::App& app, const std::string& name, const std::string& meaning) {
    return *app.add_subcommand(name, meaning);
}

void begin_group(CLI::App& command, const std::string& heading) {
    command.option_defaults()->group(heading);
}

void on_chosen(CLI::App& command, std::function<void()> choose) {
    command.callback(std::move(choose));
}

void on_understood(CLI::App& command, std::function<void()> conclude) {
    command.parse_complete_callback(std::move(conclude));
}

CLI::Option* add_value(CLI::App& command, const OptionText& text,
                       std::function<void(const OptionValue&)> read) {
    // CLI11 hands the callback no option; the longest name is how messages call it.
    const auto name = text.names.substr(text.names.find_last_of(',') + 1);
    return command
        .add_option_function<std::string>(
            text.names,
            [read = std::move(read), name](const std::string& value) {
                read({name, value});
            },
            text.meaning)
        ->type_name(text.placeholder);
}

CLI::Option* add_names(CLI::App& command, const OptionText& text, std::vector<std::string>& names) {
    return command.add_option(text.names, names, text.meaning)
        ->type_name(text.placeholder)
        ->allow_extra_args(false);
}

CLI::Option* add_files(CLI::App& command, const OptionText& text, std::vector<std::string>& files) {
    return command.add_option(text.names, files, text.meaning);
}

CLI::Option* add_flag(CLI::App& command, const std::string& names, bool& flag,
                      const std::string& meaning) {
    return command.add_flag(names, flag, meaning);
}

CLI::Option* add_flag(CLI::App& command, const std::string& names, std::function<void()> set,
                      const std::string& meaning) {
    return command.add_flag_callback(names, std::move(set), meaning);
}

void require(CLI::Option* option) { option->required(); }

void let_stand_alone(CLI::Option* option) { option->expected(0, 1); }

void need(CLI::App& command, CLI::Option* option, const std::string& other) {
    option->needs(command.get_option(other));
}

void exclude(CLI::Option* option, CLI::Option* other) { option->excludes(other); }

bool is_given(const CLI::Option* option) { return option->count() > 0; }

void describe(CLI::App& command, const std::string& option, const std::string& meaning) {
    command.get_option(option)->description(meaning);
}

void reject_both(const std::string& option, const std::string& other) {
    throw CLI::ExcludesError(option, other);
}

}  // namespace hemirad
