#include "cli/near_names.h"

#include <gtest/gtest.h>

#include "errors.h"

namespace hemirad::near_names_test {
namespace {

TEST(NearNames, TheDistanceCountsLettersWhateverTheirCase) {
    EXPECT_EQ(edit_distance("floor", "floor"), 0u);
    EXPECT_EQ(edit_distance("Floor", "fLOOR"), 0u);
    EXPECT_EQ(edit_distance("flor", "floor"), 1u);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
    EXPECT_EQ(edit_distance("", "door"), 4u);
    EXPECT_EQ(edit_distance("door", ""), 4u);
}

TEST(NearNames, WhatMayHaveBeenMeantBeginsSoOrDiffersLittle) {
    const std::vector<std::string> names{"--patch-size", "--padding", "--pe"};
    EXPECT_EQ(near_name(names, "--pacth-size"), "--patch-size");
    EXPECT_EQ(near_name(names, "--pad"), "--padding");
    EXPECT_EQ(near_name(names, "--colour"), std::nullopt);
    EXPECT_EQ(near_name({}, "--pad"), std::nullopt);
}

TEST(NearNames, ANameIsFoundAsItIsWritten) {
    EXPECT_EQ(index_of_name({"floor", "Floor", "door"}, "hall.obj", "--from", "Floor"), 1u);
}

TEST(NearNames, AnUnknownOneIsToldWithTheNearestOfAll) {
    try {
        index_of_name({"ceiling", "door", "wall 1", "wall 2", "flo\nor", "window", "lamp"},
                      "hall.obj", "--from", "flor");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "hall.obj: --from \"flor\": no surface has this name; near it: \"door\", "
                     "\"flo\\x0aor\", \"lamp\", \"wall 1\", \"wall 2\" and 2 more");
    }
}

}  // namespace
}  // namespace hemirad::near_names_test
