#pragma once

#include <array>
#include <csignal>

namespace hemirad {

/// While one lives, the first SIGINT, SIGTERM or SIGHUP is only noted, so that work can end in good
/// order; the second leaves the program at once. One at a time.
class Interrupts {
  public:
    Interrupts();
    ~Interrupts();
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;

    bool requested() const;

  private:
    std::array<struct sigaction, 3> previous_;
};

}  // namespace hemirad
