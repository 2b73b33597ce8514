#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/shared.h"

/// Kept rows of form factors as kernels/rows.clh lays them down, written and read apart from it.
namespace hemirad::test {

class KeptRows {
  public:
    /// With room for as many units, of which the first is nobody's, and words behind that no kernel
    /// may touch.
    KeptRows(std::uint32_t units, std::size_t patches, std::size_t pes)
        : words((std::size_t{units} + kBehindUnits) * kRowUnit, kUntouched),
          pool{{1, units}},
          extents(pes),
          blocks_(patches / kReduceBlock) {}

    /// Where a row may be kept; it has no blocks yet.
    std::int32_t promise() {
        const std::uint32_t row = take((blocks_ + kRowUnit - 1) / kRowUnit);
        for (std::size_t block = 0; block < blocks_; ++block) words[row * kRowUnit + block] = 0;
        return static_cast<std::int32_t>(row);
    }

    /// A row as an earlier shot has left it.
    std::int32_t keep(const std::vector<float>& row) {
        const std::int32_t at = promise();
        for (std::size_t block = 0; block < blocks_; ++block)
            words[std::size_t(at) * kRowUnit + block] = keep_block(&row[block * kReduceBlock]);
        return at;
    }

    std::vector<float> row(std::int32_t at) const {
        std::vector<float> result;
        for (std::size_t block = 0; block < blocks_; ++block) {
            const std::uint32_t unit = words[std::size_t(at) * kRowUnit + block];
            std::size_t next = std::size_t{unit} * kRowUnit + kRowBitWords;
            for (std::uint32_t patch = 0; patch < kReduceBlock; ++patch) {
                const std::size_t bits = std::size_t{unit} * kRowUnit + patch / 32;
                const bool is_seen = unit != 0 && (words.at(bits) >> patch % 32 & 1) != 0;
                result.push_back(is_seen ? std::bit_cast<float>(words.at(next++)) : 0.0f);
            }
        }
        return result;
    }

    bool is_full() const { return pool[0].taken > pool[0].size; }

    /// Whether what lies behind the last unit, but for what may be read and written of a vector, is
    /// as it was.
    bool is_whole() const {
        for (std::size_t i = std::size_t{pool[0].size} * kRowUnit; i < words.size(); ++i)
            if (words[i] != kUntouched) return false;
        return true;
    }

    std::vector<std::uint32_t> words;
    std::vector<device::RowPool> pool;
    std::vector<device::Extent> extents;

  private:
    static constexpr std::uint32_t kUntouched = 0x7fc0dead, kBehindUnits = 4 * kExtentUnits;

    std::uint32_t take(std::size_t units) {
        const std::uint32_t at = pool[0].taken;
        pool[0].taken += static_cast<std::uint32_t>(units);
        return at;
    }

    std::uint32_t keep_block(const float* values) {
        std::vector<std::uint32_t> block(kRowBitWords, 0);
        for (std::uint32_t patch = 0; patch < kReduceBlock; ++patch)
            if (values[patch] != 0) {
                block[patch / 32] |= 1u << patch % 32;
                block.push_back(std::bit_cast<std::uint32_t>(values[patch]));
            }
        if (block.size() == kRowBitWords) return 0;
        const std::uint32_t unit = take((block.size() + kRowUnit - 1) / kRowUnit);
        std::copy(block.begin(), block.end(), words.begin() + std::ptrdiff_t{unit} * kRowUnit);
        return unit;
    }

    std::size_t blocks_;
};

}  // namespace hemirad::test
