#include "solver/near_pairs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <thread>
#include <utility>

#include "errors.h"
#include "formfactor/polygon_factors.h"
#include "solver/patch_shapes.h"

namespace hemirad {
namespace {

constexpr double kErrorOfCentre = 0.1;  // times the factor and (radius / distance)^2
constexpr double kLarge = 4;            // times the median radius: not kept in cells

// Of the disk around the receiver, in its plane.
glm::dvec3 nearest_point(const PatchShape& receiver, const glm::dvec3& to) {
    const glm::dvec3 foot = to - glm::dot(to - receiver.centre, receiver.normal) * receiver.normal;
    const double away = glm::distance(foot, receiver.centre);
    if (away <= receiver.radius) return foot;
    return receiver.centre + receiver.radius / away * (foot - receiver.centre);
}

// Largest cosine under which a point sees a corner or the nearest point, against its own normal.
double largest_cosine(const glm::dvec3& from, const glm::dvec3& normal, const PatchShape& to) {
    double largest = 0;
    const auto include = [&](const glm::dvec3& point) {
        const double distance = glm::distance(point, from);
        if (distance > 0) largest = std::max(largest, glm::dot(normal, point - from) / distance);
    };
    std::ranges::for_each(to.corners, include);
    include(nearest_point(to, from));
    return largest;
}

bool in_front(const PatchShape& patch, const PatchShape& of) {
    return std::ranges::any_of(patch.corners, [&](const glm::dvec3& corner) {
        return glm::dot(of.normal, corner - of.centre) > 0;
    });
}

double error_of_centre(const PatchShape& shooter, const PatchShape& receiver) {
    if (!in_front(shooter, receiver) || !in_front(receiver, shooter)) return 0;
    const glm::dvec3 nearest = nearest_point(receiver, shooter.centre);
    const double distance = std::max(glm::distance(shooter.centre, nearest), 0.5 * shooter.radius);
    const double cosines = largest_cosine(shooter.centre, shooter.normal, receiver) *
                           largest_cosine(nearest, receiver.normal, shooter);
    const double squared = distance * distance;
    const double factor = std::min(1.0, shooter.area * cosines / (std::numbers::pi * squared));
    return kErrorOfCentre * factor * shooter.radius * shooter.radius / squared;
}

// Beyond, error_of_centre is below `error`.
double reach(const PatchShape& shooter, double error) {
    return std::sqrt(shooter.radius *
                     std::sqrt(kErrorOfCentre * shooter.area / (std::numbers::pi * error)));
}

/// Patches by the cubic cells that their centres lie in; large ones in a list of their own.
class Cells {
  public:
    Cells(std::span<const PatchShape> patches, double error) : patches_(patches), error_(error) {
        const double radius = median([](const PatchShape& patch) { return patch.radius; });
        largest_kept_ = kLarge * radius;
        edge_ =
            std::max(median([&](const PatchShape& patch) { return reach(patch, error); }), radius);
        for (std::size_t i = 0; i < patches.size(); ++i)
            (patches[i].radius > largest_kept_ ? large_ : cells_[cell_of(patches[i].centre)])
                .push_back(i);
    }

    /// Calls with every patch that a hemisphere at the shooter's centre may be wrong about.
    template <class Visit>
    void visit_near(const PatchShape& shooter, const Visit& visit) const {
        for_each_group(shooter, [&](const std::vector<std::size_t>& receivers) {
            for (const std::size_t receiver : receivers) {
                const double wrong = error_of_centre(shooter, patches_[receiver]);
                if (wrong > error_) visit(receiver, wrong);
            }
        });
    }

    /// How many patches that takes a look at.
    std::size_t candidate_count(const PatchShape& shooter) const {
        std::size_t count = 0;
        for_each_group(shooter, [&](const auto& receivers) { count += receivers.size(); });
        return count;
    }

  private:
    using Cell = std::array<std::int64_t, 3>;

    double median(const std::function<double(const PatchShape&)>& of) const {
        std::vector<double> values;
        for (const PatchShape& patch : patches_) values.push_back(of(patch));
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    }
    Cell cell_of(const glm::dvec3& point) const {
        const glm::dvec3 cell = glm::floor(point / edge_);
        return {static_cast<std::int64_t>(cell.x), static_cast<std::int64_t>(cell.y),
                static_cast<std::int64_t>(cell.z)};
    }
    template <class Visit>
    void for_each_group(const PatchShape& shooter, const Visit& visit) const {
        const glm::dvec3 far(reach(shooter, error_) + largest_kept_);
        visit(large_);
        for_each_cell(cell_of(shooter.centre - far), cell_of(shooter.centre + far), visit);
    }
    template <class Visit>
    void for_each_cell(const Cell& first, const Cell& last, const Visit& visit) const {
        // Wider than all there is: each cell once.
        if (static_cast<double>(last[0] - first[0]) * static_cast<double>(last[1] - first[1]) >
            static_cast<double>(cells_.size())) {
            for (const auto& [at, patches] : cells_) visit(patches);
            return;
        }
        for (std::int64_t x = first[0]; x <= last[0]; ++x)
            for (std::int64_t y = first[1]; y <= last[1]; ++y) {
                const auto end = cells_.upper_bound({x, y, last[2]});
                for (auto cell = cells_.lower_bound({x, y, first[2]}); cell != end; ++cell)
                    visit(cell->second);
            }
    }

    std::span<const PatchShape> patches_;
    double error_, edge_ = 1, largest_kept_ = 0;
    std::map<Cell, std::vector<std::size_t>> cells_;
    std::vector<std::size_t> large_;
};

using Pair = std::pair<std::size_t, std::size_t>;  // shooter and receiver

constexpr std::size_t kMostPairs = std::numeric_limits<std::int32_t>::max() / 2;

void require_indexable(std::size_t pairs) {
    if (pairs > kMostPairs)
        throw InputError("more than " + std::to_string(kMostPairs) +
                         " pairs of patches are near; raise --sampling-error");
}

// Either way round if one is near: the lower patch first. Both ways are found at most.
std::vector<Pair> pairs_of(std::span<const PatchShape> patches, double error) {
    const Cells cells(patches, error);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        cells.visit_near(patches[i], [&](std::size_t j, double) {
            if (j != i) pairs.push_back(std::minmax(i, j));
        });
        require_indexable(pairs.size() / 2);
    }
    std::ranges::sort(pairs);
    const auto repeated = std::ranges::unique(pairs);
    pairs.erase(repeated.begin(), repeated.end());
    return pairs;
}

bool is_own(const Shooter& shooter, std::size_t patch) {
    return patch - shooter.first_patch < shooter.patch_count;
}

std::vector<Pair> pairs_of(const Mesh& mesh, std::span<const PatchShape> shooters,
                           std::span<const PatchShape> patches, double error) {
    const Cells cells(patches, error);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < shooters.size(); ++i) {
        cells.visit_near(shooters[i], [&](std::size_t j, double) {
            if (!is_own(mesh.shooters[i], j)) pairs.emplace_back(i, j);
        });
        require_indexable(pairs.size());
    }
    std::ranges::sort(pairs);
    return pairs;
}

// Area of the smaller times its factor to the larger: what a factor errs by is absolute, and the
// other way it would be multiplied by the ratio of the areas. The contour integral's sums cancel to
// (radius / distance)^2 of themselves, so they err by 2^-53 over that; the factor from its centre
// errs by (radius / distance)^2: the lesser where that is below 2^-26.
double exchange_area(const PatchShape& smaller, const PatchShape& larger) {
    const double distance = glm::distance(smaller.centre, nearest_point(larger, smaller.centre));
    if (smaller.radius < 0x1p-13 * distance)
        return smaller.area * point_to_polygon(smaller.centre, smaller.normal, larger.corners);
    return smaller.area * polygon_to_polygon(smaller.corners, larger.corners);
}

std::vector<double> exchange_areas(std::span<const PatchShape> shooters,
                                   std::span<const PatchShape> patches,
                                   std::span<const Pair> pairs) {
    std::vector<double> result(pairs.size());
    const std::size_t thread_count = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    for (std::size_t first = 0; first < thread_count; ++first)
        threads.emplace_back([&, first] {
            for (std::size_t i = first; i < pairs.size(); i += thread_count) {
                const PatchShape &a = shooters[pairs[i].first], &b = patches[pairs[i].second];
                result[i] = a.area < b.area ? exchange_area(a, b) : exchange_area(b, a);
            }
        });
    threads.clear();  // waits
    return result;
}

NearPairs both_ways(std::span<const PatchShape> patches, double error) {
    const auto pairs = pairs_of(patches, error);
    require_indexable(pairs.size());
    const auto exchange = exchange_areas(patches, patches, pairs);

    NearPairs near;
    near.begin.assign(patches.size() + 1, 0);
    for (const auto& [a, b] : pairs) ++near.begin[a + 1], ++near.begin[b + 1];
    for (std::size_t i = 0; i < patches.size(); ++i) near.begin[i + 1] += near.begin[i];
    near.patch.resize(2 * pairs.size());
    near.form_factor.resize(2 * pairs.size());
    std::vector<std::int32_t> end(near.begin.begin(), near.begin.end() - 1);
    const auto put = [&](std::size_t from, std::size_t to, double exchanged) {
        const auto at = static_cast<std::size_t>(end[from]++);
        near.patch[at] = static_cast<std::int32_t>(to);
        near.form_factor[at] = static_cast<float>(exchanged / patches[from].area);
    };
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        put(pairs[i].first, pairs[i].second, exchange[i]);
        put(pairs[i].second, pairs[i].first, exchange[i]);
    }
    return near;
}

NearPairs from_shooters(const Mesh& mesh, std::span<const PatchShape> patches, double error) {
    const auto shooters = shooter_shapes(mesh);
    const auto pairs = pairs_of(mesh, shooters, patches, error);
    require_indexable(pairs.size());
    const auto exchange = exchange_areas(shooters, patches, pairs);

    NearPairs near;
    near.begin.assign(shooters.size() + 1, 0);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto [from, to] = pairs[i];
        near.begin[from + 1] = static_cast<std::int32_t>(i + 1);
        near.patch.push_back(static_cast<std::int32_t>(to));
        near.form_factor.push_back(static_cast<float>(exchange[i] / shooters[from].area));
    }
    for (std::size_t i = 0; i < shooters.size(); ++i)
        near.begin[i + 1] = std::max(near.begin[i], near.begin[i + 1]);
    return near;
}

}  // namespace

NearPairs near_pairs(const Mesh& mesh, double error) {
    const auto patches = patch_shapes(mesh);
    return mesh.shooters.empty() ? both_ways(patches, error) : from_shooters(mesh, patches, error);
}

std::uint64_t estimated_near_finds(const Mesh& mesh, double error) {
    constexpr std::size_t kLooks = 1000, kCandidates = 4'000'000;  // of looks: a second or two
    const auto patches = patch_shapes(mesh);
    const auto shooters = mesh.shooters.empty() ? patches : shooter_shapes(mesh);
    const Cells cells(patches, error);
    std::uint64_t found = 0, looks = 0, candidates = 0;
    std::size_t step = shooters.size() / kLooks + 1;
    for (std::size_t i = 0; i < shooters.size(); i += step)
        candidates += cells.candidate_count(shooters[i]);
    step *= candidates / kCandidates + 1;
    for (std::size_t i = 0; i < shooters.size(); i += step, ++looks)
        cells.visit_near(shooters[i], [&](std::size_t, double) { ++found; });
    return looks == 0 ? 0 : found * shooters.size() / looks;
}

std::uint64_t near_pairs_bytes(const Mesh& mesh, std::uint64_t finds) {
    const std::uint64_t pairs = mesh.shooters.empty() ? finds / 2 : finds;
    const std::uint64_t factors = mesh.shooters.empty() ? finds : 2 * std::bit_ceil(finds);
    const std::uint64_t growing = sizeof(Pair) * std::bit_ceil(finds);
    return std::max(growing, sizeof(Pair) * finds + sizeof(double) * pairs + 8 * factors);
}

std::vector<std::int32_t> shooter_samples_for(const Mesh& mesh, double error, std::int32_t most) {
    const auto patches = patch_shapes(mesh);
    const auto shooters = mesh.shooters.empty() ? patches : shooter_shapes(mesh);
    const Cells cells(patches, error);
    std::vector<std::int32_t> samples;
    for (std::size_t i = 0; i < shooters.size(); ++i) {
        double largest = error;
        cells.visit_near(shooters[i], [&](std::size_t j, double wrong) {
            const bool own = mesh.shooters.empty() ? j == i : is_own(mesh.shooters[i], j);
            if (!own) largest = std::max(largest, wrong);
        });
        const double needed = std::ceil(std::sqrt(largest / error));
        samples.push_back(static_cast<std::int32_t>(std::min<double>(needed, most)));
    }
    return samples;
}

}  // namespace hemirad
