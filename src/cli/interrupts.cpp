#include "cli/interrupts.h"

#include <unistd.h>

#include <atomic>
#include <cassert>
#include <chrono>
#include <csignal>
#include <thread>

#include "cli/exit_codes.h"

namespace hemirad {
namespace {

enum class State { unwatched, watched, requested };

// The thread of signals outlives main's objects.
std::atomic<State> g_state = State::unwatched;

bool is_ignored(int signal) {
    struct sigaction action = {};
    return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

void end_by(int signal) {
    std::signal(signal, SIG_DFL);  // a device's compiler (LLVM) has handlers of its own
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, signal);
    pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
    std::raise(signal);
}

/// Does not return.
void act_on(sigset_t signals) {
    using Clock = std::chrono::steady_clock;
    constexpr auto kTheSame = std::chrono::seconds(1);
    Clock::time_point first;
    for (int signal = 0;;) {
        if (sigwait(&signals, &signal) != 0) continue;
        auto state = State::watched;
        if (g_state.compare_exchange_strong(state, State::requested))
            first = Clock::now();
        else if (state == State::unwatched)
            end_by(signal);
        else if (signal != SIGHUP && Clock::now() - first > kTheSame)
            _exit(kInterrupted);
    }
}

}  // namespace

void take_signals() {
    sigset_t taken, blocked;
    sigemptyset(&taken);
    sigemptyset(&blocked);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        sigaddset(&blocked, signal);
        if (!is_ignored(signal)) sigaddset(&taken, signal);
    }
    pthread_sigmask(SIG_BLOCK, &blocked, nullptr);
    std::thread(act_on, taken).detach();
}

Interrupts::Interrupts() {
    [[maybe_unused]] const auto before = g_state.exchange(State::watched);
    assert(before == State::unwatched);
}

Interrupts::~Interrupts() { g_state = State::unwatched; }

bool Interrupts::requested() const { return g_state == State::requested; }

}  // namespace hemirad
