#pragma once

#include <optional>
#include <vector>

namespace hemirad {

/// When the unshot fraction will have fallen to the tolerance. Progressive radiosity sheds a
/// nearly constant share of what is left a shot (the bright emitters first, faster), so the
/// logarithm of the fraction is extrapolated, from the later half of the time so far.
class Eta {
  public:
    explicit Eta(double tolerance) : tolerance_(tolerance) {}

    void note(double seconds, double unshot_fraction);

    /// Seconds from the last note on; nothing while there is no decay to go by.
    std::optional<double> remaining() const;

  private:
    struct Sample {
        double seconds, log_unshot;
    };

    double tolerance_;
    std::vector<Sample> samples_;
};

}  // namespace hemirad
