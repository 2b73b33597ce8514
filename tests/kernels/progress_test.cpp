#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <numeric>
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

std::set<std::tuple<int, int, int>> expected_parts(unsigned known, std::uint32_t shares) {
    std::set<std::tuple<int, int, int>> expected;
    int station = 0;
    for (std::uint32_t member = 0; member < kMembers; ++member) {
        if ((known >> member & 1) != 0) continue;
        for (std::uint32_t share = 0; share < shares; ++share)
            expected.emplace(member, station, share);
        ++station;
    }
    return expected;
}

TEST(Progress, EachShareOfWhoeverLooksIsOneGroups) {
    auto run = dealing();
    for (const std::uint32_t shares : {1u, 3u, 8u})
        for (unsigned known = 0; known < 1u << kMembers; ++known) {
            if (kMembers - static_cast<unsigned>(std::popcount(known)) > kSalvo) continue;
            std::set<std::tuple<int, int, int>> dealt;
            std::size_t busy = 0;
            for (const auto& [member, station, share] :
                 parts_of(run, salvo_of(known), kSalvo * shares)) {
                if (member < 0) continue;
                ++busy;
                dealt.emplace(member, station, share);
            }

            EXPECT_EQ(dealt, expected_parts(known, shares)) << known;
            EXPECT_EQ(busy, dealt.size()) << known;
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

// [PE, count] of every work-item.
std::vector<std::int32_t> places_of(std::uint32_t groups, std::uint32_t local,
                                    std::uint32_t spacing) {
    KernelOptions options;
    options.flux_spacing = spacing;
    auto run = KernelRun::probe("progress", "place", options);
    auto places = run.plural(std::vector<std::int32_t>(2 * groups * local));
    run.issue({groups, local}, places);
    return run.acu().unload(places);
}

// PoCL's first thread takes half of the groups and one more.
TEST(Progress, TwoThreadsHaveAsManyPesToUpdateFluxes) {
    const auto places = places_of(8 * 4, 2, 4);
    std::size_t first = 0, second = 0;
    for (std::size_t i = 0; i < places.size(); i += 2)
        if (places[i] >= 0) ++(i / 2 < 17 * 2 ? first : second);

    EXPECT_EQ(first, second);
}

TEST(Progress, OfAllGroupsThatWorkOnTheSameEveryFewthHasItsPes) {
    for (const std::uint32_t spacing : {1u, 3u, 8u}) {
        const auto places = places_of(5 * spacing, 2, spacing);

        std::vector<std::int32_t> working;
        for (std::size_t i = 0; i < places.size(); i += 2) {
            EXPECT_EQ(places[i + 1], 10);
            if (places[i] >= 0) working.push_back(places[i]);
        }
        std::vector<std::int32_t> all(10);
        std::iota(all.begin(), all.end(), 0);
        EXPECT_EQ(working, all);
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
