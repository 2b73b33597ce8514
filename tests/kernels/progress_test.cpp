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
                           std::uint32_t groups, std::int32_t spacing = 1) {
    auto parts = run.plural(std::vector<std::int32_t>(3 * groups));
    run.issue({groups, 1}, run.plural(salvo), spacing, parts);
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

void expect_dealt(std::uint32_t shares, std::uint32_t spacing) {
    auto run = dealing();
    for (unsigned known = 0; known < 1u << kMembers; ++known) {
        if (kMembers - static_cast<unsigned>(std::popcount(known)) > kSalvo) continue;
        std::set<std::tuple<int, int, int>> dealt;
        std::size_t busy = 0;
        for (const auto& [member, station, share] :
             parts_of(run, salvo_of(known), kSalvo * shares * spacing, std::int32_t(spacing))) {
            if (member < 0) continue;
            ++busy;
            dealt.emplace(member, station, share);
        }

        EXPECT_EQ(dealt, expected_parts(known, shares)) << known;
        EXPECT_EQ(busy, dealt.size()) << known;
    }
}

TEST(Progress, EachShareOfWhoeverLooksIsOneGroups) {
    for (const std::uint32_t shares : {1u, 3u, 8u}) expect_dealt(shares, 1);
}

TEST(Progress, SoItIsWhereFewGroupsWork) {
    for (const std::uint32_t shares : {1u, 3u, 8u})
        for (const std::uint32_t spacing : {2u, 5u, 8u}) expect_dealt(shares, spacing);
}

// Of two cores of which one takes the first half of the groups and one more, as PoCL has them, each
// works on as much as the other.
TEST(Progress, TwoHalvesOfTheGroupsHaveAsMuchToDo) {
    auto run = dealing();
    for (const unsigned known : {0x0fu, 0x1fu, 0x3fu, 0x7fu, 0xfeu}) {
        const auto parts = parts_of(run, salvo_of(known), kSalvo * 8 * 2, 2);
        const auto middle = parts.begin() + std::ptrdiff_t(parts.size() / 2 + 1);
        const auto works = [](const Part& part) { return part.member >= 0; };
        EXPECT_EQ(std::count_if(parts.begin(), middle, works),
                  std::count_if(middle, parts.end(), works))
            << known;
    }
}

// [PE, count] of every work-item.
std::vector<std::int32_t> places_of(std::uint32_t groups, std::uint32_t local,
                                    std::uint32_t spacing) {
    KernelOptions options;
    options.stack_spacing = spacing;
    auto run = KernelRun::probe("progress", "place", options);
    auto places = run.plural(std::vector<std::int32_t>(2 * groups * local));
    run.issue({groups, local}, places);
    return run.acu().unload(places);
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
