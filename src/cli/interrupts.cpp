#include "cli/interrupts.h"

#include <unistd.h>

#include <cassert>

#include "cli/exit_codes.h"

namespace hemirad {
namespace {

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
    sigaction(SIGINT, nullptr, &previous_);
    if (previous_.sa_handler == SIG_IGN) return;  // nohup, a shell's background job
    struct sigaction action = {};
    action.sa_handler = note_interrupt;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
}

Interrupts::~Interrupts() {
    sigaction(SIGINT, &previous_, nullptr);
    g_in_use = false;
}

bool Interrupts::requested() const { return g_requested != 0; }

}  // namespace hemirad
