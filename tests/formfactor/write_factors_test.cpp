#include "formfactor/write_factors.h"

#include <gtest/gtest.h>

#include <sstream>

namespace hemirad::write_factors_test {
namespace {

/// A sends to b and back; c is a back: nothing but a column.
FactorSurfaces surfaces() {
    return {{"a", "b, \"bright\"", "c (back)"},
            {0, 1, 2},
            {0.9, 1 / 3.0, 1},
            {false, false, true},
            {true, true, false},
            {true, true, true}};
}

FormFactors factors() {
    return {{0, 1, 2},
            {{{1, 0, 2 / 3.0}, {2, 0, 0.125}}, {{0, 0, 1 / 3.0}}, {{0, 0, 0.25}}},
            {1 - 2 / 3.0 - 0.125, 2 / 3.0, 0.75},
            {1, 2, 0.5}};
}

template <class Write>
std::string written(Write write) {
    std::ostringstream out;
    write(out);
    return out.str();
}

TEST(WriteFactorsCsv, PairsThatAreNot0ThenTheOutside) {
    EXPECT_EQ(written([](auto& out) { write_factors_csv(out, factors(), surfaces(), false); }),
              "from,to,form_factor\n"
              "a,\"b, \"\"bright\"\"\",0.666666667\n"
              "a,c (back),0.125\n"
              "\"b, \"\"bright\"\"\",a,0.333333333\n"
              "a,outside,0.208333333\n"
              "\"b, \"\"bright\"\"\",outside,0.666666667\n");
}

TEST(WriteFactorsCsv, EveryPairOfFronts) {
    FactorSurfaces of_b = surfaces();
    of_b.as_from = {false, true, false};

    EXPECT_EQ(written([&](auto& out) { write_factors_csv(out, factors(), of_b, true); }),
              "from,to,form_factor\n"
              "\"b, \"\"bright\"\"\",a,0.333333333\n"
              "\"b, \"\"bright\"\"\",\"b, \"\"bright\"\"\",0\n"
              "\"b, \"\"bright\"\"\",outside,0.666666667\n");
}

TEST(WriteFactorsCsv, ColumnsThatAreNotListedAreLeftOut) {
    FactorSurfaces no_c = surfaces();
    no_c.as_to = {true, false, false};

    EXPECT_EQ(written([&](auto& out) { write_factors_csv(out, factors(), no_c, false); }),
              "from,to,form_factor\n"
              "\"b, \"\"bright\"\"\",a,0.333333333\n"
              "a,outside,0.208333333\n"
              "\"b, \"\"bright\"\"\",outside,0.666666667\n");
}

TEST(WriteView3d, HeaderAreasRowsEmittances) {
    EXPECT_EQ(written([](auto& out) { write_view3d(out, factors(), surfaces()); }),
              "View3D 3.3.1 0 0 0 2          \n"
              "1 2\n"
              "0 0.666666667\n"
              "0.333333333 0\n"
              "0.9 0.333333333\n");
}

TEST(WriteView3d, AnEnclosureIsMarked) {
    const FormFactors closed{{0, 1}, {{{1, 0, 1.0}}, {{0, 0, 0.5}, {1, 0, 0.5}}}, {0, 0}, {1, 2}};
    const FactorSurfaces two{{"a", "b"},     {0, 1},       {1, 1},
                             {false, false}, {true, true}, {true, true}};

    EXPECT_EQ(written([&](auto& out) { write_view3d(out, closed, two); }),
              "View3D 3.3.1 0 1 0 2          \n1 2\n0 1\n0.5 0.5\n1 1\n");
}

TEST(WriteView3d, WhatGoesToBlockersLeavesTheEnclosureOpen) {
    FormFactors closed = factors();
    closed.outside = {0, 0, 0};

    EXPECT_EQ(written([&](auto& out) { write_view3d(out, closed, surfaces()); }).substr(0, 19),
              "View3D 3.3.1 0 0 0 ");
}

TEST(WriteView3dSparse, ALineAFactor) {
    EXPECT_EQ(written([](auto& out) { write_view3d_sparse(out, factors(), surfaces()); }),
              "View3D 3.3.1 2 0 0 2          \n"
              "1 2\n"
              "1 2 0.666666667\n"
              "2 1 0.333333333\n"
              "0.9 0.333333333\n");
}

}  // namespace
}  // namespace hemirad::write_factors_test
