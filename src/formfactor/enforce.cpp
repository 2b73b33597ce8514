#include "formfactor/enforce.h"

#include <algorithm>
#include <cmath>

namespace hemirad {
namespace {

/// Of the sum of a row; sums of doubles are no better.
constexpr double kClosure = 1e-13, kNearClosure = 1e-6;
constexpr int kRefinements = 6;
/// A tenth of both is enough but where most factors are wrong, or none hold the laws.
constexpr int kNewtonSteps = 30, kGradientSteps = 200;

constexpr double kDamping = 1e-8;  // of the curvature

/// A symmetric G_ij = A_i F_ij = A_j F_ji, m^2: what was found, and the variance of that.
struct Pair {
    std::uint32_t i, j;  ///< i <= j
    double error;        ///< 0: not known
    double found, variance;
};

/// The dual of the least squares problem has one multiplier a row. With them,
/// G_ij = max(0, found + variance (l_i + l_j)), outside likewise with l_i alone.
struct Dual {
    const std::vector<double>& area;
    std::vector<Pair> pairs;
    std::vector<double> outside, outside_variance;  ///< [row], times area
    std::vector<double> multiplier;                 ///< [row]
};

double square(double x) { return x * x; }

/// The factor's error, or the factor itself where none is known, times the area.
double deviation(const FormFactor& f, double area) {
    return area * (f.error > 0 ? double(f.error) : f.value);
}

/// Two findings of one quantity, weighed by their variances.
Pair both(std::uint32_t i, std::uint32_t j, const FormFactors& factors, const FormFactor& there,
          const FormFactor& back) {
    const double v = square(deviation(there, factors.area[i]));
    const double w = square(deviation(back, factors.area[j]));
    const double trust = v + w > 0 ? w / (v + w) : 0.5;  // squares of tiny factors are 0
    const double found =
        trust * factors.area[i] * there.value + (1 - trust) * factors.area[j] * back.value;
    return {i, j, factors.area[i] * there.error, found, trust * v};
}

Pair one(std::uint32_t i, std::uint32_t j, const FormFactors& factors, const FormFactor& f) {
    return {std::min(i, j), std::max(i, j), factors.area[i] * f.error, factors.area[i] * f.value,
            square(deviation(f, factors.area[i]))};
}

const FormFactor* find(const std::vector<FormFactor>& row, std::uint32_t to) {
    const auto found = std::ranges::lower_bound(row, to, {}, &FormFactor::to);
    return found != row.end() && found->to == to && found->value > 0 ? &*found : nullptr;
}

/// A pair that one side alone has seen, being smaller than a proxel from the other, is a pair.
std::vector<Pair> pairs_of(const FormFactors& factors) {
    std::vector<Pair> pairs;
    for (std::uint32_t i = 0; i < factors.rows.size(); ++i)
        for (const FormFactor& f : factors.rows[i]) {
            if (f.value <= 0) continue;
            const FormFactor* back = f.to == i ? nullptr : find(factors.rows[f.to], i);
            if (back == nullptr) pairs.push_back(one(i, f.to, factors, f));
            if (back != nullptr && i < f.to) pairs.push_back(both(i, f.to, factors, f, *back));
        }
    return pairs;
}

Dual dual_of(const FormFactors& factors) {
    Dual dual{factors.area, pairs_of(factors), factors.outside, {}, {}};
    for (std::size_t i = 0; i < dual.outside.size(); ++i) dual.outside[i] *= dual.area[i];
    for (const double found : dual.outside) dual.outside_variance.push_back(square(found));
    dual.multiplier.assign(dual.area.size(), 0);
    return dual;
}

double value(const Dual& dual, const Pair& pair) {
    const auto& l = dual.multiplier;
    const double sum = pair.i == pair.j ? l[pair.i] : l[pair.i] + l[pair.j];
    return std::max(0.0, pair.found + pair.variance * sum);
}

double outside_value(const Dual& dual, std::size_t row) {
    return std::max(0.0, dual.outside[row] + dual.outside_variance[row] * dual.multiplier[row]);
}

/// What each row lacks to its area.
std::vector<double> lacks(const Dual& dual) {
    std::vector<double> lack = dual.area;
    for (std::size_t i = 0; i < lack.size(); ++i) lack[i] -= outside_value(dual, i);
    for (const Pair& pair : dual.pairs) {
        const double g = value(dual, pair);
        lack[pair.i] -= g;
        if (pair.i != pair.j) lack[pair.j] -= g;
    }
    return lack;
}

double largest_lack(const Dual& dual, const std::vector<double>& lack) {
    double largest = 0;
    for (std::size_t i = 0; i < lack.size(); ++i)
        largest = std::max(largest, std::abs(lack[i]) / dual.area[i]);
    return largest;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

void add(std::vector<double>& a, double factor, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
}

/// How row sums answer to the multipliers, of the factors that are above 0.
struct Slope {
    std::vector<Pair> pairs;  ///< `variance` of these alone
    std::vector<double> outside, diagonal;

    std::vector<double> operator()(const std::vector<double>& step) const {
        std::vector<double> change(step.size());
        for (std::size_t i = 0; i < step.size(); ++i) change[i] = outside[i] * step[i];
        for (const Pair& pair : pairs) {
            const bool is_self = pair.i == pair.j;
            const double g = pair.variance * (is_self ? step[pair.i] : step[pair.i] + step[pair.j]);
            change[pair.i] += g;
            if (!is_self) change[pair.j] += g;
        }
        return change;
    }
};

void add_diagonal(const std::vector<Pair>& pairs, std::vector<double>& diagonal) {
    for (const Pair& pair : pairs) {
        diagonal[pair.i] += pair.variance;
        if (pair.i != pair.j) diagonal[pair.j] += pair.variance;
    }
}

/// Levenberg 1944: where too much has become 0 for the rows to move one by one, they still do.
void damp(const Dual& dual, Slope& slope) {
    std::vector<double> of_all = dual.outside_variance;
    add_diagonal(dual.pairs, of_all);
    for (std::size_t i = 0; i < of_all.size(); ++i) slope.outside[i] += kDamping * of_all[i];
}

Slope slope_of(const Dual& dual) {
    Slope slope;
    for (const Pair& pair : dual.pairs)
        if (value(dual, pair) > 0) slope.pairs.push_back(pair);
    for (std::size_t i = 0; i < dual.area.size(); ++i)
        slope.outside.push_back(outside_value(dual, i) > 0 ? dual.outside_variance[i] : 0);
    damp(dual, slope);
    slope.diagonal = slope.outside;
    add_diagonal(slope.pairs, slope.diagonal);
    return slope;
}

std::vector<double> preconditioned(const Slope& slope, const std::vector<double>& lack) {
    std::vector<double> result(lack.size());
    for (std::size_t i = 0; i < lack.size(); ++i)
        result[i] = slope.diagonal[i] > 0 ? lack[i] / slope.diagonal[i] : 0;
    return result;
}

/// Conjugate gradients (Hestenes and Stiefel 1952), scaled by the diagonal.
std::vector<double> newton_step(const Slope& slope, std::vector<double> lack) {
    std::vector<double> step(lack.size(), 0.0);
    auto scaled = preconditioned(slope, lack);
    auto direction = scaled;
    double norm = dot(lack, scaled);
    const double enough = square(1e-8) * norm;
    for (int i = 0; i < kGradientSteps && norm > enough; ++i) {
        const auto change = slope(direction);
        const double curvature = dot(direction, change);
        if (!(curvature > 0)) break;
        add(step, norm / curvature, direction);
        add(lack, -norm / curvature, change);
        scaled = preconditioned(slope, lack);
        const double next = dot(lack, scaled);
        for (std::size_t k = 0; k < step.size(); ++k)
            direction[k] = scaled[k] + next / norm * direction[k];
        norm = next;
    }
    return step;
}

/// The dual is concave: along the step, its derivative falls from dot(lack, step) on. Halved until
/// it has not fallen far below 0. False where no step helps.
bool go(Dual& dual, const std::vector<double>& step, std::vector<double>& lack) {
    const double rise = dot(lack, step);
    const auto start = dual.multiplier;
    for (double length = 1; length > 1e-9; length /= 2) {
        dual.multiplier = start;
        add(dual.multiplier, length, step);
        auto next = lacks(dual);
        if (dot(next, step) < -0.5 * rise) continue;
        lack = std::move(next);
        return true;
    }
    dual.multiplier = start;
    return false;
}

void maximise(Dual& dual) {
    auto lack = lacks(dual);
    for (int i = 0; largest_lack(dual, lack) > kClosure && i < kNewtonSteps; ++i) {
        const auto step = newton_step(slope_of(dual), lack);
        if (!(dot(lack, step) > 0) || !go(dual, step, lack)) return;
    }
}

/// Starts anew from where the multipliers have led: where they are large, sums of them are not
/// precise to kClosure. What is 0 stays so once the rows are nearly right.
void refine(Dual& dual) {
    const bool is_near = largest_lack(dual, lacks(dual)) < kNearClosure;
    for (Pair& pair : dual.pairs) {
        pair.found = value(dual, pair);
        if (is_near && pair.found == 0) pair.variance = 0;
    }
    for (std::size_t i = 0; i < dual.outside.size(); ++i) {
        dual.outside[i] = outside_value(dual, i);
        if (is_near && dual.outside[i] == 0) dual.outside_variance[i] = 0;
    }
    std::ranges::fill(dual.multiplier, 0);
    maximise(dual);
}

void put(FormFactors& factors, std::uint32_t row, std::uint32_t to, const Pair& pair, double g) {
    if (g <= 0) return;
    const double area = factors.area[row];
    factors.rows[row].push_back({to, float(pair.error / area), g / area});
}

void put_back(const Dual& dual, FormFactors& factors) {
    for (auto& row : factors.rows) row.clear();
    for (const Pair& pair : dual.pairs) {
        // More than all of a patch is only asked for where the laws cannot be held.
        const double g = std::min({value(dual, pair), factors.area[pair.i], factors.area[pair.j]});
        put(factors, pair.i, pair.j, pair, g);
        if (pair.i != pair.j) put(factors, pair.j, pair.i, pair, g);
    }
    for (auto& row : factors.rows) std::ranges::sort(row, {}, &FormFactor::to);
    for (std::size_t i = 0; i < factors.outside.size(); ++i)
        factors.outside[i] = outside_value(dual, i) / factors.area[i];
}

}  // namespace

void enforce(FormFactors& factors) {
    Dual dual = dual_of(factors);
    maximise(dual);
    for (int i = 0; i < kRefinements && largest_lack(dual, lacks(dual)) > kClosure; ++i)
        refine(dual);
    put_back(dual, factors);
}

}  // namespace hemirad
