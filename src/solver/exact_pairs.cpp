#include "solver/exact_pairs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <glm/geometric.hpp>
#include <numbers>
#include <thread>
#include <utility>

namespace hemirad {
namespace {

constexpr int kMostPoints = 1000000;

// Of both patches, over-estimated: the cosines are those of the highest points of their spheres.
double largest_exchange_share(const PatchShape& a, const PatchShape& b) {
    const glm::dvec3 gap = b.centre - a.centre;
    const double distance = glm::length(gap);
    const double above_a = glm::dot(a.normal, gap) + b.radius;
    const double above_b = -glm::dot(b.normal, gap) + a.radius;
    if (above_a <= 0 || above_b <= 0) return 0;
    const double nearest = distance - 0.5 * (a.radius + b.radius);
    if (nearest <= 0) return 1;
    const double cosines = std::min(1.0, above_a / nearest) * std::min(1.0, above_b / nearest);
    const double larger = std::max(a.area, b.area);
    return std::min(1.0, larger * cosines / (std::numbers::pi * nearest * nearest));
}

double distance_of(const PatchShape& a, const PatchShape& b) {
    return glm::distance(a.centre, b.centre);
}

}  // namespace

// One thread's part of the work.
struct ExactPairs::Worker {
    PatchSpheres spheres;
    std::vector<ConvexPolygon> blockers;
    std::vector<ExactPair> found;
};

double HemisphereError::of(double unblocked, const PatchShape& from, const PatchShape& to) const {
    // Whether a point is in shadow varies over the patch; without shadows the kernel does, which
    // the midpoint rule finds to second order in the size over the distance, but for edges that
    // touch.
    constexpr double kShadow = 0.65, kNear = 1;
    const double reach = std::min(1.0, std::max(from.radius, to.radius) / distance_of(from, to));
    const double share = kShadow / (samples * std::sqrt(samples)) + kNear * reach * reach / samples;
    return std::min(1.0, share) * unblocked + of_outline(unblocked);
}

double HemisphereError::of_whole(double factor) const {
    return 0.1 / (samples * std::sqrt(samples)) * std::min(factor, std::abs(1 - factor)) +
           of_outline(factor);
}

// Proxels on an outline, six times the root of what it holds as for a slender triangle, are in or
// out by chance.
double HemisphereError::of_outline(double factor) const {
    const double disk = std::numbers::pi / 4 * resolution * resolution;
    const double outline = 6 * std::sqrt(std::max(1.0, factor * disk));
    return std::sqrt(outline) / (disk * samples);
}

ExactPairs::ExactPairs(const std::vector<PatchShape>& patches, const HemisphereError& error,
                       double target, bool symmetric, std::vector<bool> covered)
    : patches_(patches),
      error_(error),
      target_(target),
      symmetric_(symmetric),
      covered_(std::move(covered)) {}

bool ExactPairs::may_need_it(const PatchShape& from, const PatchShape& to) const {
    const double share = largest_exchange_share(from, to);
    return share > 0 && error_.of(share, from, to) > target_;
}

bool ExactPairs::needs_it(const PatchShape& from, const PatchShape& to, double unblocked) const {
    const double larger = std::max(unblocked, unblocked * from.area / to.area);
    return larger > 0 && error_.of(larger, from, to) > target_;
}

bool ExactPairs::integrate_pair(std::uint32_t i, std::uint32_t j, bool both, Worker& worker) const {
    if (i == j || (both && j < i)) return false;
    const std::uint32_t row = i;
    // From the smaller one, so that the error of the way back is smaller still.
    if (both && patches_[j].area < patches_[i].area) std::swap(i, j);
    if (symmetric_ && covered_[i] && !covered_[j]) std::swap(i, j);
    const PatchShape &a = patches_[i], &b = patches_[j];
    if (!may_need_it(a, b)) return false;
    const double unblocked = polygon_to_polygon(a.corners, b.corners);
    if (!needs_it(a, b, unblocked)) return false;
    worker.spheres.between(i, j, worker.blockers);
    const Estimate there =
        blocked_polygon_to_polygon(a.corners, b.corners, unblocked, worker.blockers,
                                   target_ * std::min(1.0, b.area / a.area), kMostPoints);
    const double scale = a.area / b.area;
    if (both || i == row) worker.found.push_back({i, j, there});
    if (both || j == row)
        worker.found.push_back({j, i, {there.value * scale, there.error * scale}});
    return true;
}

std::vector<ExactPair> ExactPairs::integrate(
    const std::vector<std::uint32_t>& from,
    const std::function<bool(std::size_t)>& on_progress) const {
    std::vector<bool> is_row(patches_.size(), false);
    for (const std::uint32_t patch : from) is_row[patch] = true;
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> stopped = false;
    const auto work = [&](bool reports) {
        Worker worker{PatchSpheres(patches_), {}, {}};
        for (std::size_t row; !stopped && (row = next++) < from.size();) {
            if (reports && !on_progress(row)) stopped = true;
            for (std::uint32_t to = 0; !stopped && to < patches_.size(); ++to)
                if (integrate_pair(from[row], to, symmetric_ && is_row[to], worker) && reports &&
                    !on_progress(row))
                    stopped = true;
        }
        return std::move(worker.found);
    };
    std::vector<std::future<std::vector<ExactPair>>> others;
    for (unsigned k = 1; k < std::thread::hardware_concurrency(); ++k)
        others.push_back(std::async(std::launch::async, work, false));
    std::vector<ExactPair> all = work(true);
    for (auto& other : others) {
        const auto found = other.get();
        all.insert(all.end(), found.begin(), found.end());
    }
    if (!stopped) on_progress(from.size());
    return all;
}

}  // namespace hemirad
