#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hemirad {

/// Whether what took so long, and was such a share of all, tells how long the rest will take: the
/// first rows and shots are no measure of the others.
bool is_enough_to_foretell(double seconds, double share);

/// ", 3 min 20 s left"; nothing where that is not known, or longer than anybody waits: 1,000 h.
std::string left_text(std::optional<double> seconds);

/// When the unshot fraction will have fallen to the tolerance. Progressive radiosity sheds a
/// nearly constant share of what is left a shot (the bright emitters first, faster), so the
/// logarithm of the fraction is extrapolated, from the later half of the time so far.
class Eta {
  public:
    explicit Eta(double tolerance) : tolerance_(tolerance) {}

    void note(double seconds, double unshot_fraction);

    /// Seconds from the last note on; nothing while there is no decay to go by, or too little of
    /// it: see is_enough_to_foretell().
    std::optional<double> remaining() const;

  private:
    struct Sample {
        double seconds, log_unshot;
    };

    double tolerance_;
    std::vector<Sample> samples_;
};

}  // namespace hemirad
