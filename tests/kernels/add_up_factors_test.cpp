#include <gtest/gtest.h>

#include <random>

#include "support/kernel_run.h"
#include "support/pipeline.h"

namespace hemirad::test::add_up_factors_test {
namespace {

constexpr std::uint32_t kStride = 5 * kReduceBlock;

std::vector<float> random_factors() {
    std::mt19937 random(130);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<float> factors(kFactorKinds * kStride);
    std::generate(factors.begin(), factors.end(), [&] { return unit(random); });
    return factors;
}

std::vector<float> block_sums(const std::vector<float>& factors, const Shape& shape) {
    KernelOptions options;
    options.lanes = shape.lanes;
    KernelRun run("add_up_factors", options);
    device::Shot shot{};
    shot.status = kRunning;
    auto sums = run.acu().plural<float>(2 * kStride / kReduceBlock);
    run.issue(run.fitting({2, std::size_t{shape.width} * shape.height}),
              run.plural(std::vector{shot}), run.plural(factors), std::int32_t(kStride), sums);
    return run.acu().unload(sums);
}

TEST(AddUpFactors, GivesTheSumsOfTheBlocksInBitsThatDoNotDependOnTheArray) {
    const auto factors = random_factors();
    const auto first = block_sums(factors, shapes().front());

    for (std::size_t block = 0; block < kStride / kReduceBlock; ++block)
        for (const auto& [kind, at] : {std::pair{kVisibleFactor, 0}, {kDoubtfulFactor, 1}}) {
            double expected = 0;
            for (std::size_t i = 0; i < kReduceBlock; ++i)
                expected += factors[kind * kStride + block * kReduceBlock + i];
            EXPECT_NEAR(first[2 * block + at], expected, kReduceBlock * expected * 0x1p-24);
        }
    for (const auto& shape : shapes())
        EXPECT_EQ(bits(block_sums(factors, shape)), bits(first)) << shape;
}

}  // namespace
}  // namespace hemirad::test::add_up_factors_test
