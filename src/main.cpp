#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <string_view>

#include "cli/command_line.h"
#include "cli/exit_codes.h"
#include "cli/interrupts.h"
#include "errors.h"
#include "mp1map/device.h"
#include "scene/printable.h"

namespace {

int complain(std::string_view fault, int exit_code) {
    std::cerr << hemirad::printable(fault) << '\n';
    return exit_code;
}

/// A device's fault may bring the log of its compiler after the first line.
int complain_with_log(std::string_view fault) {
    const auto first_line = fault.substr(0, fault.find('\n'));
    complain("hemirad: " + std::string(first_line), hemirad::kDeviceFailed);
    if (first_line.size() < fault.size()) std::cerr << fault.substr(first_line.size() + 1) << '\n';
    return hemirad::kDeviceFailed;
}

/// Asks for no memory.
int complain_of_memory() {
    std::fputs("hemirad: out of memory\n", stderr);
    return hemirad::kWrongUse;
}

int complain_of_the_unexpected(const std::exception& fault) {
    if (const auto device = mp1map::failure_text(fault); !device.empty())
        return complain_with_log(device);
    return complain("hemirad: " + std::string(fault.what()), hemirad::kWrongUse);
}

/// A limit of files' sizes, or a reader who has gone, is to be an error of the write, as a full disk
/// is. Blocked, not ignored: a device's compiler (LLVM) takes all handlers away.
void block_signals_of_writes() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGXFSZ);
    sigaddset(&signals, SIGPIPE);
    sigprocmask(SIG_BLOCK, &signals, nullptr);
}

int run(int argc, const char* const* argv) {
    hemirad::CommandLine command_line;
    try {
        return command_line.run(argc, argv);
    } catch (const CLI::Success& question) {  // --help and --version come as exceptions
        return command_line.answer(question);
    }
}

/// Of what is being handled.
int complain_of_what_was_thrown() {
    using namespace hemirad;
    using namespace std::string_literals;
    try {
        throw;
    } catch (const CLI::ParseError& fault) {
        return complain("hemirad: "s + fault.what(), kWrongUse);
    } catch (const InputError& fault) {
        return complain(fault.what(), kWrongUse);
    } catch (const OutputError& fault) {
        return complain(fault.what(), kNotWritten);
    } catch (const mp1map::NoSuchDevice& fault) {
        return complain("hemirad: "s + fault.what(), kWrongUse);
    } catch (const mp1map::DeviceError& fault) {
        return complain_with_log(fault.what());
    } catch (const std::bad_alloc&) {
        return complain_of_memory();
    } catch (const std::exception& fault) {
        return complain_of_the_unexpected(fault);
    }
}

int complain_without_throwing() {
    try {
        return complain_of_what_was_thrown();
    } catch (const std::bad_alloc&) {  // of the message itself
        return complain_of_memory();
    } catch (...) {
        std::fputs("hemirad: something was thrown that is no exception\n", stderr);
        return hemirad::kWrongUse;
    }
}

/// Where no catch is reached: destructors of nlohmann::json ask for memory, and may not throw.
/// Nothing is lost by leaving at once, as files have no name before they are whole. A reserve of
/// memory for std::set_new_handler to free would be the other way; but it is gone after the first
/// request, and what other std::terminates are called for would still be an abort without a word.
[[noreturn]] void leave() {
    if (std::current_exception()) _exit(complain_without_throwing());
    std::fputs("hemirad: cannot go on, for a fault of its own\n", stderr);
    _exit(hemirad::kWrongUse);
}

/// Before CLI11's validators ask for memory, which are made before main.
[[gnu::constructor(101)]] void set_terminate_early() { std::set_terminate(leave); }

}  // namespace

int main(int argc, char** argv) {
    block_signals_of_writes();
    try {
        hemirad::take_signals();
        return run(argc, argv);
    } catch (...) {
        return complain_without_throwing();
    }
}
