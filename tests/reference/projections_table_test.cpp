#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "tests/reference/views.h"

// Sec. 1.3.3, "for an equal number of sampling elements, a better form factor approximation is
// obtained": RMS errors of single points' factors, printed as CSV and held to that order.
namespace hemirad::reference::projections_table_test {
namespace {

const std::vector<double> kSamples{768, 3072, 12288, 49152, 196608};

struct Row {
    std::vector<double> errors;  ///< [samples]
    double slope;                ///< against resolution
};

Row row_of(const char* views_name, const std::vector<View>& views, const char* method_name,
           const Method& method, int (*resolution_of)(double)) {
    Row row;
    std::vector<int> resolutions;
    std::string line = std::string(views_name) + "," + method_name;
    for (const double samples : kSamples) {
        resolutions.push_back(resolution_of(samples));
        row.errors.push_back(rms_error(views, method, resolutions.back()));
        char text[16];
        std::snprintf(text, sizeof text, ",%.2e", row.errors.back());
        line += text;
    }
    row.slope = slope(resolutions, row.errors);
    std::printf("%s,%.2f\n", line.c_str(), row.slope);
    return row;
}

struct Case {
    const char* name;
    std::vector<View> views;
    /// Of the hemisphere's error over the hemicube's, at any number of samples.
    double most;
    double hemicube_slope;
};

class Projections : public testing::TestWithParam<int> {};

Case case_of(int index) {
    switch (index) {
        case 0:
            return {"triangles of 0.1", triangle_views(1000, 0.1), 0.95, -1.5};
        case 1:
            return {"triangles of 0.3", triangle_views(1000, 0.3), 0.95, -1.5};
        case 2:  // where a polygon fills much of the hemisphere, the hemicube draws level
            return {"triangles of 1", triangle_views(600, 1), 1.5, -1.5};
        case 3:
            return {"walls along the axes", room_views(40, 1), 0.5, -1};
        case 4:
            return {"8 x 8 quads a wall along the axes", room_views(20, 8), 0.8, -1};
        default:
            return {"8 x 8 quads a turned wall", room_views(20, 8, Frame::turned), 0.95, -1.3};
    }
}

TEST_P(Projections, KeepTheirOrderAtEqualNumbersOfSamples) {
    const Case tried = case_of(GetParam());
    const auto row = [&](const char* name, const Method& method, int (*resolution)(double)) {
        return row_of(tried.name, tried.views, name, method, resolution);
    };

    std::printf("views,method,768,3072,12288,49152,196608,slope\n");
    const Row hemisphere = row("hemisphere", by_hemisphere, hemisphere_of);
    const Row hemicube = row("hemicube", by_hemicube, hemicube_of);
    const Row planes[] = {row("plane of half width 3", by_plane(3), plane_of),
                          row("plane of half width 7", by_plane(7), plane_of),
                          row("plane of half width 15", by_plane(15), plane_of)};

    EXPECT_NEAR(hemisphere.slope, -1.5, 0.15);
    EXPECT_NEAR(hemicube.slope, tried.hemicube_slope, 0.2);
    for (std::size_t i = 0; i < kSamples.size(); ++i) {
        EXPECT_LT(hemisphere.errors[i], tried.most * hemicube.errors[i]);
        for (const Row& plane : planes) EXPECT_LT(hemisphere.errors[i], 0.5 * plane.errors[i]);
    }
}

INSTANTIATE_TEST_SUITE_P(Views, Projections, testing::Range(0, 6));

}  // namespace
}  // namespace hemirad::reference::projections_table_test
