#pragma once

#include <csignal>

namespace hemirad {

/// While one lives, the first SIGINT is only noted, so that work can end in good order; the second
/// leaves the program at once. One at a time.
class Interrupts {
  public:
    Interrupts();
    ~Interrupts();
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;

    bool requested() const;

  private:
    struct sigaction previous_;
};

}  // namespace hemirad
