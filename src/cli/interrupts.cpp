#include "cli/interrupts.h"

#include <unistd.h>

#include <cassert>

#include "cli/exit_codes.h"

namespace hemirad {
namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};

// A signal handler reaches nothing but globals.
volatile std::sig_atomic_t g_requested = 0;
bool g_in_use = false;

extern "C" void note_interrupt(int) {
    if (g_requested != 0) _exit(kInterrupted);
    g_requested = 1;
}

}  // namespace

Interrupts::Interrupts() {
    assert(!g_in_use);
    g_in_use = true;
    g_requested = 0;
    struct sigaction action = {};
    action.sa_handler = note_interrupt;
    action.sa_flags = SA_RESTART;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals[i], nullptr, &previous_[i]);
        if (previous_[i].sa_handler == SIG_IGN) continue;
        sigaction(kSignals[i], &action, nullptr);
    }
}

Interrupts::~Interrupts() {
    for (std::size_t i = 0; i < kSignals.size(); ++i)
        sigaction(kSignals[i], &previous_[i], nullptr);
    g_in_use = false;
}

bool Interrupts::requested() const { return g_requested != 0; }

}  // namespace hemirad
