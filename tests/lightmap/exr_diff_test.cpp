#include <sys/wait.h>

#include <cstdlib>
#include <limits>

#include "lightmap/support.h"
#include "lightmap/write_exr.h"

namespace hemirad::exr_diff_test {
namespace {

class ExrDiff : public InFolder {
  protected:
    void write(const std::string& name, float first_texel) {
        Lightmap lightmap = numbered_lightmap(4, 3, {"R", "G", "B"});
        lightmap.values[1][0] = first_texel;
        write_exr(file(name), lightmap, {});
    }

    int exit_code(const std::string& arguments) const {
        const std::string command = "cd '" + folder_.string() + "' && '" HEMI_EXR_DIFF "' " +
                                    arguments + " > out.txt 2> err.txt";
        return WEXITSTATUS(std::system(command.c_str()));
    }
};

TEST_F(ExrDiff, IdenticalPixelsExitWithZero) {
    write("a.exr", 1.0f);
    write("b.exr", 1.0f);

    EXPECT_EQ(exit_code("a.exr b.exr"), 0);
    EXPECT_NE(bytes_of(file("out.txt")).find("identical"), std::string::npos);
}

TEST_F(ExrDiff, ADifferenceAboveTheToleranceExitsWithOne) {
    write("a.exr", 1.0f);
    write("b.exr", 1.25f);

    EXPECT_EQ(exit_code("a.exr b.exr"), 1);
    EXPECT_EQ(exit_code("a.exr b.exr --tolerance 0.2"), 1);
    EXPECT_EQ(exit_code("a.exr b.exr --tolerance 0.25"), 0);
}

TEST_F(ExrDiff, ANumberAgainstNoNumberIsADifference) {
    write("a.exr", 1.0f);
    write("b.exr", std::numeric_limits<float>::quiet_NaN());

    EXPECT_EQ(exit_code("a.exr b.exr --tolerance 100"), 1);
    EXPECT_EQ(exit_code("b.exr b.exr"), 0);
}

TEST_F(ExrDiff, WhatCannotBeComparedExitsWithTwo) {
    write("a.exr", 1.0f);
    write_exr(file("other_bands.exr"), numbered_lightmap(4, 3, {"R", "G"}), {});
    write_exr(file("other_size.exr"), numbered_lightmap(3, 4, {"R", "G", "B"}), {});

    EXPECT_EQ(exit_code("a.exr other_bands.exr"), 2);
    EXPECT_EQ(exit_code("a.exr other_size.exr"), 2);
    EXPECT_EQ(exit_code("a.exr missing.exr"), 2);
    EXPECT_EQ(exit_code("a.exr"), 2);
    EXPECT_EQ(exit_code("a.exr a.exr --tolerance much"), 2);
}

}  // namespace
}  // namespace hemirad::exr_diff_test
