#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <glm/mat3x3.hpp>
#include <iostream>
#include <random>

#include "extremes/stage.h"

/// One quantity taken from where it is harmless to where it is absurd.
namespace hemirad::test {

struct Value {
    std::string name;
    double at;
};

inline std::vector<double> powers_of_ten(int first, int last) {
    std::vector<double> values;
    const int step = first <= last ? 1 : -1;
    for (int k = first; k != last + step; k += step) values.push_back(std::pow(10.0, k));
    return values;
}

inline std::vector<Polygon> turned(std::vector<Polygon> polygons, const glm::dmat3& rotation) {
    for (auto& polygon : polygons)
        for (auto& corner : polygon.corners) corner = rotation * corner;
    return polygons;
}
inline std::vector<Polygon> scaled(std::vector<Polygon> polygons, double factor) {
    for (auto& polygon : polygons)
        for (auto& corner : polygon.corners) corner *= factor;
    return polygons;
}
inline std::vector<Polygon> moved(std::vector<Polygon> polygons, const glm::dvec3& by) {
    for (auto& polygon : polygons)
        for (auto& corner : polygon.corners) corner += by;
    return polygons;
}

inline std::vector<Polygon> joined(std::vector<Polygon> a, const std::vector<Polygon>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

inline Polygon quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                    const glm::dvec3& d) {
    return {{a, b, c, d}};
}

/// Prints a row of a sweep for the tables of limits.
inline void print(const std::string& axis, double at, const std::string& result) {
    std::cout << "limit: " << axis << " | " << at << " | " << result << "\n";
}
inline std::string text(const Agreement& all) {
    std::ostringstream out;
    out << all.proxels << " proxels | " << all.undecided << " undecided | " << all.wrong
        << " wrong";
    return out.str();
}

/// All that is seen is admitted by double precision at every value. The limit recorded is the last
/// value before more than one proxel in a hundred depends on rounding.
inline void expect_agreement(const std::string& axis, const std::vector<double>& values,
                             const std::function<Agreement(double)>& seen_at) {
    double limit = 0;
    bool clear = true;
    for (const double at : values) {
        const Agreement all = seen_at(at);
        EXPECT_EQ(all.wrong, 0u) << axis << " " << at << ": " << all.first_wrong;
        EXPECT_GT(all.proxels, 0u);
        print(axis, at, text(all));
        clear = clear && 100 * all.undecided <= all.proxels;
        if (clear) limit = at;
    }
    std::ostringstream out;
    out << limit;
    testing::Test::RecordProperty("one_in_a_hundred_undecided_beyond", out.str());
}

}  // namespace hemirad::test
