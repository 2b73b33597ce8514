#include "lightmap/part_names.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace hemirad::part_names_test {
namespace {

std::vector<std::string> names_of_lights(const std::vector<std::string>& lights) {
    Solution solution;
    for (const auto& name : lights)
        solution.parts.push_back({SolutionPart::Kind::light, name, {}, {}, {}});
    return part_names(solution);
}

TEST(PartNames, OfPlainLightsAreTheirOwn) {
    EXPECT_EQ(names_of_lights({"Lamp_1-a"}), std::vector<std::string>{"light.Lamp_1-a"});
}

TEST(PartNames, OfDirectAndIndirectLightAreNoLights) {
    Solution solution;
    solution.parts = {{SolutionPart::Kind::light, "direct", {}, {}, {}},
                      {SolutionPart::Kind::direct, "", {}, {}, {}},
                      {SolutionPart::Kind::indirect, "", {}, {}, {}}};

    EXPECT_EQ(part_names(solution),
              (std::vector<std::string>{"light.direct", "direct", "indirect"}));
}

TEST(PartNames, EscapeWhatWouldPartLayersOrBreakLines) {
    EXPECT_EQ(names_of_lights({"Lamp.001", "a/b", "x\ny", "50%", "K\u00fcche", " \",="}),
              (std::vector<std::string>{"light.Lamp%2E001", "light.a%2Fb", "light.x%0Ay",
                                        "light.50%25", "light.K%C3%BCche", "light.%20%22%2C%3D"}));
}

TEST(PartNames, AreDifferentWhereTheLightsAre) {
    const std::string long_name(1000, 'x');
    const std::vector<std::string> lights{
        "",  "a.b",           "a%2Eb",         "a b",  "a~1", "~0",   "A.b",
        "_", long_name + "a", long_name + "b", "\xff", "%FF", "a\\b", "a_b"};

    const auto names = names_of_lights(lights);

    EXPECT_EQ(std::set(names.begin(), names.end()).size(), lights.size());
    for (const auto& name : names) {
        EXPECT_LT(name.size(), 140u);
        EXPECT_EQ(std::ranges::count(name, '.'), 1) << name;
        EXPECT_NE(name, "light.");
    }
}

}  // namespace
}  // namespace hemirad::part_names_test
