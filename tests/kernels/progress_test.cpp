#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <set>
#include <tuple>

#include "kernels/shared.h"
#include "support/kernel_run.h"

namespace hemirad::test::progress_test {
namespace {

constexpr std::uint32_t kSalvo = 4, kMembers = 2 * kSalvo;

// Members that have a row, one bit each; the others look.
std::vector<device::Shot> salvo_of(unsigned known) {
    std::vector<device::Shot> salvo(kMembers);
    for (std::uint32_t member = 0; member < kMembers; ++member) {
        salvo[member].status = kRunning;
        salvo[member].row_known = static_cast<std::int32_t>(known >> member & 1);
    }
    return salvo;
}

struct Part {
    std::int32_t member, station, share;
};

std::vector<Part> parts_of(KernelRun& run, const std::vector<device::Shot>& salvo,
                           std::uint32_t groups) {
    auto parts = run.plural(std::vector<std::int32_t>(3 * groups));
    run.issue({groups, 1}, run.plural(salvo), parts);
    const auto words = run.acu().unload(parts);
    std::vector<Part> result;
    for (std::size_t group = 0; group < groups; ++group)
        result.push_back({words[3 * group], words[3 * group + 1], words[3 * group + 2]});
    return result;
}

KernelRun dealing() {
    KernelOptions options;
    options.salvo = kSalvo;
    return KernelRun::probe("progress", "deal", options);
}

TEST(Progress, EachShareOfWhoeverLooksIsOneGroups) {
    auto run = dealing();
    for (const std::uint32_t shares : {1u, 3u, 8u})
        for (unsigned known = 0; known < 1u << kMembers; ++known) {
            const auto looking = kMembers - static_cast<unsigned>(std::popcount(known));
            if (looking > kSalvo) continue;

            std::set<std::tuple<int, int, int>> dealt;
            std::size_t busy = 0;
            for (const auto& [member, station, share] :
                 parts_of(run, salvo_of(known), kSalvo * shares)) {
                if (member < 0) continue;
                ++busy;
                dealt.emplace(member, station, share);
            }

            std::set<std::tuple<int, int, int>> expected;
            int station = 0;
            for (std::uint32_t member = 0; member < kMembers; ++member) {
                if ((known >> member & 1) != 0) continue;
                for (std::uint32_t share = 0; share < shares; ++share)
                    expected.emplace(member, station, share);
                ++station;
            }
            EXPECT_EQ(dealt, expected) << known;
            EXPECT_EQ(busy, expected.size()) << known;
        }
}

// Of two cores that take a half of the groups each, each works on as much as the other.
TEST(Progress, TwoHalvesOfTheGroupsHaveAsMuchToDo) {
    auto run = dealing();
    for (const unsigned known : {0x0fu, 0x1fu, 0x3fu, 0x7fu, 0xfeu}) {
        const auto parts = parts_of(run, salvo_of(known), kSalvo * 8);
        const auto busy = [&](std::size_t first) {
            return std::count_if(parts.begin() + std::ptrdiff_t(first),
                                 parts.begin() + std::ptrdiff_t(first + parts.size() / 2),
                                 [](const Part& part) { return part.member >= 0; });
        };
        EXPECT_EQ(busy(0), busy(parts.size() / 2)) << known;
    }
}

// A shooter that has made its hemispheres keeps its station while others of the salvo go on.
TEST(Progress, WhoIsDoneKeepsItsStation) {
    auto run = dealing();
    auto salvo = salvo_of(0xf0);
    salvo[1].is_done = 1;

    std::set<std::pair<int, int>> stations;
    for (const auto& [member, station, share] : parts_of(run, salvo, kSalvo * 2))
        if (member >= 0) stations.emplace(member, station);

    EXPECT_EQ(stations, (std::set<std::pair<int, int>>{{0, 0}, {2, 2}, {3, 3}}));
}

}  // namespace
}  // namespace hemirad::test::progress_test
