#include "cli/tradeoff_csv.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace hemirad::tradeoff_csv_test {
namespace {

const TradeoffScene kScene{"a, \"b\"", 0.5, 12};

void add_factors(TradeoffCsv& csv, double seconds, double error) {
    csv.add(kScene, FactorPoint{}, 3, {100, seconds, {error, 2 * error, 0.25}});
}

void add_solve(TradeoffCsv& csv, double seconds, double patches_error, double faces_error) {
    csv.add(kScene, SolvePoint{}, {7, 700, seconds, {patches_error, 1, faces_error}});
}

/// Rows after the header.
std::vector<std::string> lines_of(const TradeoffCsv& csv) {
    const auto file =
        std::filesystem::path(testing::TempDir()) /
        (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".csv");
    csv.write(file);
    std::ifstream in(file);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    std::filesystem::remove(file);
    lines.erase(lines.begin());
    return lines;
}

std::string front_of(const TradeoffCsv& csv) {
    std::string marks;
    for (const auto& line : lines_of(csv)) marks += line.back();
    return marks;
}

TEST(TradeoffCsv, MarksWhatNoOtherRowBeatsInBothTimeAndError) {
    TradeoffCsv csv;
    add_factors(csv, 1, 4);
    add_factors(csv, 2, 5);  // slower and farther off than the first
    add_factors(csv, 3, 1);
    add_factors(csv, 3, 2);  // as slow as the one before, and farther off
    add_factors(csv, 4, 1);  // as near, and slower

    EXPECT_EQ(front_of(csv), "10100");
}

TEST(TradeoffCsv, MarksEqualRowsAlike) {
    TradeoffCsv csv;
    add_factors(csv, 1, 4);
    add_factors(csv, 1, 4);

    EXPECT_EQ(front_of(csv), "11");
}

TEST(TradeoffCsv, ComparesSolvesByFacesAndWithSolvesOnly) {
    TradeoffCsv csv;
    add_factors(csv, 0.1, 0.1);
    add_solve(csv, 1, 5, 2);
    add_solve(csv, 2, 4, 3);  // nearer by patches, but not by faces
    add_solve(csv, 3, 6, 1);

    EXPECT_EQ(front_of(csv), "1101");
}

TEST(TradeoffCsv, KeepsTheNumberOfFieldsWhateverTheName) {
    TradeoffCsv csv;
    add_factors(csv, 1, 2);
    add_solve(csv, 1, 2, 3);

    const auto lines = lines_of(csv);

    EXPECT_EQ(lines[0], "factors,a   b ,count,device,0.5,12,,,,3,,100,1,2,4,0.25,,1");
    EXPECT_EQ(lines[1], "solve,a   b ,count,device,0.5,12,0,0,,,7,700,1,2,1,,3,1");
}

}  // namespace
}  // namespace hemirad::tradeoff_csv_test
