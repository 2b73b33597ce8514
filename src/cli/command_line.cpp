#include "cli/command_line.h"

#include <iostream>

#include "cli/devices.h"
#include "cli/exit_codes.h"
#include "cli/formfactors.h"
#include "cli/info.h"
#include "cli/near_names.h"
#include "cli/render.h"
#include "cli/solve.h"
#include "cli/sweep.h"
#include "cli/tradeoff.h"
#include "cli/view.h"
#include "errors.h"
#include "scene/printable.h"

namespace hemirad {
namespace {

/// What may have been meant, of the command's options or commands.
std::string guess(const CLI::App& command, const std::string& stray) {
    std::vector<std::string> names;
    for (const auto* const option : command.get_options())
        for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    if (!stray.starts_with('-')) {
        names.clear();
        for (const auto* const one : command.get_subcommands({})) names.push_back(one->get_name());
    }
    const auto near = near_name(names, stray.substr(0, stray.find('=')));
    return near ? " (did you mean " + *near + "?)" : "";
}

/// CLI11 would name every stray argument in one breath, the values of unknown options included.
void reject_stray_arguments(const CLI::App& app) {
    const auto stray = app.remaining(true);
    if (stray.empty()) return;
    const auto commands = app.get_subcommands();
    const std::string name = commands.empty() ? "" : " " + commands.front()->get_name();
    const bool is_option = stray.front().starts_with('-');
    const std::string kind = is_option          ? "unknown option"
                             : commands.empty() ? "unknown command"
                                                : "one argument too many,";
    const auto& command = commands.empty() ? app : *commands.front();
    throw InputError("hemirad: " + kind + " \"" + printable(stray.front()) + '"' +
                     (is_option || commands.empty() ? guess(command, stray.front()) : "") +
                     "; see hemirad" + name + " --help");
}

void flush(std::ostream& out) {
    if (!out.flush()) throw OutputError("standard output: could not be written");
}

}  // namespace

CommandLine::CommandLine()
    : app_("Progressive radiosity by hemispherical projection, on OpenCL devices", "hemirad") {
    app_.set_version_flag("--version", std::string("hemirad ") + HEMIRAD_VERSION);
    app_.allow_extras();
    app_.get_formatter()->column_width(34);
    add_solve(app_, chosen_);
    add_formfactors(app_, chosen_);
    add_info(app_, chosen_);
    add_devices(app_, chosen_);
    add_view(app_, chosen_);
    add_render(app_, chosen_);
    add_sweep(app_, chosen_);
    add_tradeoff(app_, chosen_);
    for (auto* const command : app_.get_subcommands({})) command->allow_extras();
}

int CommandLine::run(int argc, const char* const* argv) {
    app_.parse(argc, argv);
    reject_stray_arguments(app_);
    if (!chosen_) throw InputError("hemirad: no command given; see hemirad --help");
    const int exit_code = chosen_();
    flush(std::cout);
    return exit_code;
}

int CommandLine::answer(const CLI::Success& question) const {
    app_.exit(question, std::cout, std::cerr);
    flush(std::cout);
    return kDone;
}

}  // namespace hemirad
