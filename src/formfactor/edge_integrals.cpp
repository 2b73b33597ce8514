#include "formfactor/edge_integrals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace hemirad::formfactor {
namespace {

// Relative to the segments: below, lines count as parallel or as crossing.
constexpr double kSameDirection = 1e-9;
constexpr double kSamePlane = 1e-13;
// The closed form of crossing lines loses the square of the distance of their crossing, in
// segment lengths, to cancellation: 1e-16 * 30^2 is harmless.
constexpr double kFarCrossing = 30;

constexpr std::size_t kMostNodes = 20;
constexpr int kMostHalvings = 24;

struct Rule {
    std::vector<double> nodes, weights;  // on [-1, 1]
};

// Gauss and Legendre: roots of P_n by Newton's method from Chebyshev-like guesses.
Rule gauss_rule(std::size_t n) {
    Rule rule;
    for (std::size_t k = 0; k < n; ++k) {
        double x = std::cos(std::numbers::pi * (double(k) + 0.75) / (double(n) + 0.5));
        double slope = 1;
        for (int step = 0; step < 8; ++step) {
            double before = 1, p = x;
            for (std::size_t degree = 2; degree <= n; ++degree) {
                const double next =
                    ((2.0 * double(degree) - 1) * x * p - (double(degree) - 1) * before) /
                    double(degree);
                before = std::exchange(p, next);
            }
            slope = double(n) * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        rule.nodes.push_back(x);
        rule.weights.push_back(2 / ((1 - x * x) * slope * slope));
    }
    return rule;
}

const Rule& rule_of(std::size_t n) {
    static const std::vector<Rule> rules = [] {
        std::vector<Rule> all(kMostNodes + 1);
        for (std::size_t k = 2; k <= kMostNodes; ++k) all[k] = gauss_rule(k);
        return all;
    }();
    return rules[n];
}

double half_log(double squared) { return squared > 0 ? 0.5 * std::log(squared) : 0; }

// Integral of ln sqrt(s^2 + h^2) from s0 to s1.
double log_integral(double s0, double s1, double h) {
    const double hh = h * h;
    return s1 * half_log(s1 * s1 + hh) - s0 * half_log(s0 * s0 + hh) - (s1 - s0) +
           h * std::atan2(h * (s1 - s0), hh + s0 * s1);
}

// A second antiderivative of ln sqrt(x^2 + h^2).
double second_antiderivative(double x, double h) {
    const double xx = x * x, hh = h * h;
    return 0.5 * (xx - hh) * half_log(xx + hh) - 0.75 * xx + (h > 0 ? h * x * std::atan(x / h) : 0);
}

// Parallel or antiparallel: the integrand depends on the difference of two coordinates only.
double between_parallels(const Segment& a, const Segment& b) {
    const glm::dvec3 gap = b.start - a.start;
    const double begin = glm::dot(gap, a.along);
    const double end = begin + std::copysign(b.length, glm::dot(a.along, b.along));
    const double low = std::min(begin, end), high = std::max(begin, end);
    const double h = glm::length(glm::cross(gap, a.along));
    return second_antiderivative(high, h) - second_antiderivative(high - a.length, h) -
           second_antiderivative(low, h) + second_antiderivative(low - a.length, h);
}

struct Crossing {
    double on_a, on_b;  // coordinates of the points where two lines are nearest
    double gap, sine;
};

std::optional<Crossing> crossing_of(const Segment& a, const Segment& b) {
    const glm::dvec3 across = glm::cross(a.along, b.along);
    const double squared_sine = glm::dot(across, across);
    if (squared_sine < kSameDirection * kSameDirection) return {};
    const glm::dvec3 gap = b.start - a.start;
    const double sine = std::sqrt(squared_sine);
    return Crossing{glm::dot(glm::cross(gap, b.along), across) / squared_sine,
                    glm::dot(glm::cross(gap, a.along), across) / squared_sine,
                    std::abs(glm::dot(gap, across)) / sine, sine};
}

// I(s, t): s from 0, t from 0, along lines that meet at 0 under an angle. As I(cs, ct) =
// c^2 (I(s, t) + s t ln c), Euler's theorem gives s dI/ds + t dI/dt = 2 I + s t, where the
// derivatives are integrals along one line.
double from_crossing(double s, double t, double cosine, double sine) {
    const double ds = log_integral(-s * cosine, t - s * cosine, std::abs(s) * sine);
    const double dt = log_integral(-t * cosine, s - t * cosine, std::abs(t) * sine);
    return 0.5 * (s * ds + t * dt - s * t);
}

double between_crossing(const Segment& a, const Segment& b, const Crossing& at) {
    const double cosine = glm::dot(a.along, b.along);
    const double s0 = -at.on_a, s1 = a.length - at.on_a;
    const double t0 = -at.on_b, t1 = b.length - at.on_b;
    const auto corner = [&](double s, double t) { return from_crossing(s, t, cosine, at.sine); };
    return corner(s1, t1) - corner(s0, t1) - corner(s1, t0) + corner(s0, t0);
}

bool meet(const Segment& a, const Segment& b, const Crossing& at) {
    const double longer = std::max(a.length, b.length);
    return at.gap <= kSamePlane * longer && std::abs(at.on_a) < kFarCrossing * longer &&
           std::abs(at.on_b) < kFarCrossing * longer;
}

// Complex coordinates along `outer` at which the inner integral is singular: the ends of `inner`
// at distance 0, and its inside where the line passes it.
struct Singularities {
    std::array<std::complex<double>, 3> at;
    std::size_t count = 0;

    void add(double coordinate, double distance) { at[count++] = {coordinate, distance}; }
};

Singularities singularities(const Segment& outer, const Segment& inner,
                            const std::optional<Crossing>& crossing) {
    Singularities found;
    for (const glm::dvec3& end : {inner.start, inner.at(inner.length)})
        found.add(glm::dot(end - outer.start, outer.along),
                  glm::length(glm::cross(end - outer.start, outer.along)));
    const double beside = 0.5 * inner.length;
    if (crossing && crossing->on_b > -beside && crossing->on_b < inner.length + beside)
        found.add(crossing->on_a, crossing->gap / crossing->sine);
    return found;
}

// Gauss-Legendre converges as 1 / (a + sqrt(a^2 - 1))^(2 n), where a is half of the sum of the
// distances of the nearest singularity to the ends of [-1, 1] (Bernstein's ellipse).
double nodes_needed(const Singularities& singular, double begin, double end, double digits) {
    const double half = 0.5 * (end - begin);
    double least = 1e9;
    for (std::size_t k = 0; k < singular.count; ++k) {
        const double x = singular.at[k].real(), y = singular.at[k].imag();
        const double to_ends =
            std::sqrt((x - begin) * (x - begin) + y * y) + std::sqrt((x - end) * (x - end) + y * y);
        least = std::min(least, to_ends / (2 * half));
    }
    const double squared = least * least - 1;
    if (squared <= 0) return 1e9;
    return 1 + digits / (2 * std::log(least + std::sqrt(squared)));
}

double quadrature(const Segment& outer, const Segment& inner, double begin, double end,
                  std::size_t node_count) {
    const Rule& rule = rule_of(node_count);
    const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    double sum = 0;
    for (std::size_t k = 0; k < node_count; ++k)
        sum += rule.weights[k] * log_distance(outer.at(middle + half * rule.nodes[k]), inner);
    return half * sum;
}

struct Outer {
    const Segment &outer, &inner;
    Singularities singular;
    double digits;  // natural logarithm of 1 / tolerance

    double integral(double begin, double end, int halvings) const {
        const double needed = nodes_needed(singular, begin, end, digits);
        if (needed <= double(kMostNodes) || halvings == kMostHalvings)
            return quadrature(outer, inner, begin, end,
                              std::size_t(std::clamp(needed, 2.0, double(kMostNodes))));
        const double middle = 0.5 * (begin + end);
        return integral(begin, middle, halvings + 1) + integral(middle, end, halvings + 1);
    }
};

}  // namespace

double log_distance(const glm::dvec3& point, const Segment& segment) {
    const glm::dvec3 gap = segment.start - point;
    const double s0 = glm::dot(gap, segment.along);
    return log_integral(s0, s0 + segment.length, glm::length(glm::cross(gap, segment.along)));
}

double log_distance(const Segment& a, const Segment& b, double tolerance) {
    if (b.length < a.length) return log_distance(b, a, tolerance);
    const auto crossing = crossing_of(a, b);
    if (!crossing) return between_parallels(a, b);
    if (meet(a, b, *crossing)) return between_crossing(a, b, *crossing);
    const Outer outer{a, b, singularities(a, b, crossing), -std::log(tolerance)};
    return outer.integral(0, a.length, 0);
}

}  // namespace hemirad::formfactor
