#pragma once

namespace hemirad {

/// To be called before there is another thread: SIGINT, SIGTERM and SIGHUP are blocked in all that
/// come, and in programs that these start (a linker of a device's compiler must not die of a
/// Ctrl-C), and taken by a thread of its own. What was ignored from the start stays so.
void take_signals();

/// While one lives, the first SIGINT, SIGTERM or SIGHUP is only noted, so that work can end in good
/// order; the next leaves the program at once. Not a SIGHUP, and none within a second: terminals,
/// timeout(1) and shells tell a program and its group. Without one, signals end the program, as
/// they do by default. One at a time.
class Interrupts {
  public:
    Interrupts();
    ~Interrupts();
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;

    bool requested() const;
};

}  // namespace hemirad
