#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "fuzz/targets.h"

/// The corpus of tools/fuzz, and some thousand mutations of it, always the same ones: no fuzzing,
/// but what an ordinary compiler and a few seconds allow.
namespace hemirad::fuzz {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<fs::path> seeds_of(const Target& target) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(fs::path(HEMI_CORPUS) / target.name))
        files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

class Mutator {
  public:
    std::string mutated(std::string bytes) {
        for (std::size_t changes = 1 + below(4); changes > 0 && !bytes.empty(); --changes)
            change(bytes);
        return bytes;
    }

  private:
    std::size_t below(std::size_t end) { return random_() % end; }

    void change(std::string& bytes) {
        const std::size_t at = below(bytes.size());
        const std::size_t length = 1 + below(std::min<std::size_t>(bytes.size() - at, 16));
        switch (below(5)) {
            case 0:
                bytes[at] = static_cast<char>(below(256));
                break;
            case 1:
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
                break;
            case 2:
                bytes.erase(at, length);
                break;
            case 3:
                bytes.insert(below(bytes.size()), bytes.substr(at, length));
                break;
            default:
                bytes.insert(at, kWords[below(std::size(kWords))]);
                break;
        }
    }

    static constexpr const char* kWords[] = {
        "-1", "0", "4294967295", "1e308", "-1e-320", "nan",         "inf", "\n", "\xff\xff\xff\xff",
        "{",  "[", "\"",         "%2e",   "../",     "\xe2\x80\xae"};
    std::minstd_rand random_;  // its numbers are the standard's, wherever the test runs
};

std::string fault_of(const Target& target, const std::string& bytes) {
    try {
        target.take(bytes);
    } catch (const std::exception& fault) {
        return fault.what();
    }
    return {};
}

/// Leaves what was not answered where somebody can look at it.
void expect_answer(const Target& target, const fs::path& seed, const std::string& bytes) {
    const std::string fault = fault_of(target, bytes);
    if (fault.empty()) return;
    const std::string name = std::string("unanswered-") + target.name;
    std::ofstream(name, std::ios::binary) << bytes;
    FAIL() << seed << ", see " << fs::absolute(name) << ": " << fault;
}

class Hostile : public testing::TestWithParam<Target> {};

INSTANTIATE_TEST_SUITE_P(Bytes, Hostile, testing::ValuesIn(kTargets),
                         [](const auto& target) { return std::string(target.param.name); });

TEST_P(Hostile, AreTakenOrRefusedInOneLine) {
    Mutator mutator;
    const auto seeds = seeds_of(GetParam());
    ASSERT_FALSE(seeds.empty());

    for (const fs::path& seed : seeds) {
        const std::string bytes = content_of(seed);
        expect_answer(GetParam(), seed, bytes);
        for (int i = 0; i < GetParam().mutations && !HasFatalFailure(); ++i)
            expect_answer(GetParam(), seed, mutator.mutated(bytes));
    }
}

}  // namespace
}  // namespace hemirad::fuzz
