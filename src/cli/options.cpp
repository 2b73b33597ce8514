#include "cli/options.h"

namespace hemirad {

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

}  // namespace hemirad
