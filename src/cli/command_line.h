#pragma once

#include <CLI/CLI.hpp>

#include "cli/options.h"

namespace hemirad {

/// The program behind main(): which command, with which options.
class CommandLine {
  public:
    CommandLine();

    /// Understands the arguments and does the work; returns the exit code. Faults are thrown,
    /// CLI::Success where --help or --version asks for answer().
    int run(int argc, const char* const* argv);

    /// Prints what `question` asked for; returns the exit code.
    int answer(const CLI::Success& question) const;

  private:
    CLI::App app_;
    Command chosen_;
};

}  // namespace hemirad
