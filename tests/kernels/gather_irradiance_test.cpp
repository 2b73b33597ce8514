#include <gtest/gtest.h>

#include <random>

#include "support/kernel_run.h"
#include "support/pipeline.h"

namespace hemirad::test::gather_irradiance_test {
namespace {

constexpr std::uint32_t kStride = 5 * kReduceBlock, kBlocks = 5, kBands = 3;
constexpr std::int32_t kDiskProxels = 3209;

std::vector<device::Shot> salvo_of(std::size_t members, std::size_t aimed) {
    std::vector<device::Shot> salvo(members);
    for (std::size_t i = 0; i < members; ++i) {
        salvo[i].status = kRunning;
        salvo[i].part = salvo[i].part_count = 1;
        salvo[i].shooter = i < aimed ? static_cast<std::int32_t>(i + 7) : -1;
        salvo[i].row_known = i < aimed ? 0 : 1;
    }
    return salvo;
}

struct Sums {
    std::vector<float> sums;  // [station][band][block]
    std::vector<std::int32_t> counts;
};

/// Proxels that every third patch of each of two stations owns.
std::vector<std::int32_t> random_counts() {
    std::mt19937 random(7);
    std::vector<std::int32_t> counts(2 * (kStride + kCountsGap));
    for (std::size_t i = 0; i < counts.size(); i += 3)
        if (i % (kStride + kCountsGap) < 4 * kReduceBlock)
            counts[i] = static_cast<std::int32_t>(random() % 300);
    return counts;
}

std::vector<float> random_radiosity() {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<float> radiosity(kBands * kStride);
    std::generate(radiosity.begin(), radiosity.end(), [&] { return unit(random); });
    return radiosity;
}

Sums gathered(const Shape& shape, std::int32_t status = kRunning) {
    KernelOptions options;
    options.lanes = shape.lanes;
    options.salvo = 2;
    KernelRun run("gather_irradiance", options);
    auto salvo = salvo_of(4, 2);
    salvo[1].status = status;
    auto counts = run.plural(random_counts());
    auto sums = run.acu().plural<float>(2 * kBands * kBlocks);
    run.issue(run.fitting({4, std::size_t{shape.width} * shape.height}), run.plural(salvo), counts,
              kDiskProxels, run.acu().plural<float>(1), std::int32_t(kStride),
              run.plural(random_radiosity()), std::int32_t(kBands), sums);
    return {run.acu().unload(sums), run.acu().unload(counts)};
}

TEST(GatherIrradiance, SumsFormFactorsTimesRadiosityByBlocksInBitsThatDoNotDependOnTheArray) {
    const auto counts = random_counts();
    const auto radiosity = random_radiosity();

    const auto first = gathered(shapes().front());

    for (std::size_t station = 0; station < 2; ++station)
        for (std::size_t band = 0; band < kBands; ++band)
            for (std::size_t block = 0; block < kBlocks; ++block) {
                double expected = 0;
                for (std::size_t i = block * kReduceBlock; i < (block + 1) * kReduceBlock; ++i)
                    expected += double(counts[station * (kStride + kCountsGap) + i]) /
                                kDiskProxels * radiosity[band * kStride + i];
                EXPECT_NEAR(first.sums[(station * kBands + band) * kBlocks + block], expected,
                            kReduceBlock * expected * 0x1p-24);
            }
    for (const auto& shape : shapes())
        EXPECT_EQ(bits(gathered(shape).sums), bits(first.sums)) << shape;
}

TEST(GatherIrradiance, SpendsTheCounts) {
    const auto counts = gathered(shapes().front()).counts;

    for (std::size_t station = 0; station < 2; ++station)
        for (std::size_t patch = 0; patch < kStride; ++patch)
            EXPECT_EQ(counts[station * (kStride + kCountsGap) + patch], 0);
}

TEST(GatherIrradiance, DoesNothingWhereAMemberHasHalted) {
    const auto halted = gathered(shapes().front(), kBinsFull);

    EXPECT_EQ(halted.counts, random_counts());
    for (const float sum : halted.sums) EXPECT_EQ(sum, 0);
}

TEST(AddUpIrradiance, GivesAPointTheSumOfItsBlocksAndSpendsTheSpareCounts) {
    constexpr std::uint32_t kMany = 100;
    KernelOptions options;
    options.salvo = 2;
    options.reduce_pes = 8;
    KernelRun run("add_up_irradiance", options);
    std::vector<float> sums;
    for (std::uint32_t i = 0; i < 2 * kBands * kMany; ++i) sums.push_back(float(i % 17));
    auto counts = run.plural(std::vector<std::int32_t>(2 * (kStride + kCountsGap), 5));
    auto irradiance = run.acu().plural<float>(10 * kBands);

    run.issue({2 * kBands, 8}, run.plural(salvo_of(4, 2)), run.plural(sums), std::int32_t(kMany),
              std::int32_t(kBands), counts, std::int32_t(kStride), irradiance);

    const auto found = run.acu().unload(irradiance);
    for (std::size_t station = 0; station < 2; ++station)
        for (std::size_t band = 0; band < kBands; ++band) {
            float expected = 0;  // of small whole numbers, exact
            for (std::size_t block = 0; block < kMany; ++block)
                expected += sums[(station * kBands + band) * kMany + block];
            EXPECT_EQ(found[(7 + station) * kBands + band], expected);
        }
    for (std::size_t i = 0; i < 7 * kBands; ++i) EXPECT_EQ(found[i], 0);
    const auto left = run.acu().unload(counts);
    for (std::size_t station = 0; station < 2; ++station)
        for (std::size_t i = 0; i < kStride + kCountsGap; ++i)
            EXPECT_EQ(left[station * (kStride + kCountsGap) + i],
                      i >= kStride && i < kStride + kSpareCounts ? 0 : 5);
}

std::vector<device::GatherPoint> numbered_points(int count) {
    std::vector<device::GatherPoint> points(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        auto& point = points[static_cast<std::size_t>(i)];
        point.plane = 10 * i;
        point.reached = 7 * i;
        for (int axis = 0; axis < 3; ++axis) {
            point.origin[axis] = 100 * i + axis;
            point.u_axis[axis] = float(i + axis);
            point.v_axis[axis] = float(2 * i + axis);
            point.normal[axis] = float(3 * i + axis);
        }
    }
    return points;
}

std::vector<device::Shot> aimed(std::int32_t first, std::int32_t end, std::int32_t status) {
    KernelOptions options;
    options.salvo = 3;
    KernelRun run("aim_points", options);
    std::vector<device::Shot> before(6);
    for (auto& shot : before) {
        shot.shooter = 55;
        shot.status = kRunning;
    }
    before[1].status = status;
    auto salvo = run.plural(before);
    run.issue({6, 1}, salvo, run.plural(numbered_points(8)), first, end);
    return run.acu().unload(salvo);
}

TEST(AimPoints, GivesEachOfASalvoAPointAndLeavesOutTheRest) {
    const auto points = numbered_points(8);

    const auto salvo = aimed(3, 5, kRunning);

    for (std::size_t i = 0; i < 2; ++i) {
        const auto& point = points[3 + i];
        EXPECT_EQ(salvo[i].shooter, std::int32_t(3 + i));
        EXPECT_EQ(salvo[i].row_known, 0);
        EXPECT_EQ(salvo[i].part, 1u);
        EXPECT_EQ(salvo[i].plane, point.plane);
        EXPECT_EQ(salvo[i].reached, point.reached);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(salvo[i].origin[axis], point.origin[axis]);
            EXPECT_EQ(salvo[i].u_axis[axis], point.u_axis[axis]);
            EXPECT_EQ(salvo[i].v_axis[axis], point.v_axis[axis]);
            EXPECT_EQ(salvo[i].normal[axis], point.normal[axis]);
        }
    }
    for (std::size_t i = 2; i < 6; ++i) {
        EXPECT_EQ(salvo[i].shooter, -1);
        EXPECT_EQ(salvo[i].row_known, 1);
    }
}

TEST(AimPoints, GoesNoFurtherWhereAMemberHasHalted) {
    for (const auto& shot : aimed(0, 8, kBinsFull)) EXPECT_EQ(shot.shooter, 55);
}

}  // namespace
}  // namespace hemirad::test::gather_irradiance_test
