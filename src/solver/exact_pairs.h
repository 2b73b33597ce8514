#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "formfactor/blocked_factor.h"
#include "solver/patch_spheres.h"

namespace hemirad {

/// What M x M hemispheres of N x N proxels are off by, with a confidence of 99 %. Calibrated on
/// random triangles that hide one another (tests/solver/view_factors_test.cpp).
struct HemisphereError {
    std::uint32_t resolution = 512;
    double samples = 1;

    /// Of a factor that nothing would raise above `unblocked`.
    double of(double unblocked, const PatchShape& from, const PatchShape& to) const;
    /// Of a large share of the disk, in many parts.
    double of_whole(double factor) const;

  private:
    double of_outline(double factor) const;
};

/// A factor of one row, integrated.
struct ExactPair {
    std::uint32_t from, to;
    Estimate factor;
};

/// Integrates pairs that hemispheres leave too uncertain, on all cores.
class ExactPairs {
  public:
    /// `symmetric`: what hides one patch from another hides it the other way too.
    /// `covered`: patches that something lies on, which hides them from others but not others from
    /// them: their pairs are looked at from the other side.
    ExactPairs(const std::vector<PatchShape>& patches, const HemisphereError& error, double target,
               bool symmetric, std::vector<bool> covered);

    /// Factors from the patches of `from` whose error by hemispheres might be over the target; both
    /// directions of a pair where both are rows. `on_progress` is called, by this
    /// thread, with rows taken up; false stops.
    std::vector<ExactPair> integrate(const std::vector<std::uint32_t>& from,
                                     const std::function<bool(std::size_t)>& on_progress) const;

  private:
    struct Worker;

    bool integrate_pair(std::uint32_t i, std::uint32_t j, bool both, Worker& worker) const;
    bool may_need_it(const PatchShape& from, const PatchShape& to) const;
    bool needs_it(const PatchShape& from, const PatchShape& to, double unblocked) const;

    const std::vector<PatchShape>& patches_;
    HemisphereError error_;
    double target_;
    bool symmetric_;
    std::vector<bool> covered_;
};

}  // namespace hemirad
