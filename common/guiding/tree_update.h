#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/base/bytes.h"

namespace treefarm {

/// Bins of a region's mixture histogram (mixture.h).
inline constexpr int kMixtureBins = 16;

/// What a path vertex taught: `value` of radiance arrived from the direction `code`.
struct Record {
    std::uint32_t region;
    std::uint32_t code;      ///< Z-order code of the direction
    std::uint32_t rounding;  ///< uniform bits of the keyed generator, for stochastic rounding
    float value;             ///< L / p (or what else the tree's target is), >= 0 and finite
    float reflected = 0.0f;  ///< f |cos| L / p, >= 0 and finite: what the mixture learns from
    std::uint8_t bin = 0;    ///< of the mixture histogram, below kMixtureBins
};

/// Caps that were met. Nothing is dropped silently: they travel with the update and are reported.
struct UpdateCaps {
    std::uint64_t capped_records = 0;     ///< contributions above 2^40 quanta
    std::uint64_t saturated_cells = 0;    ///< sums that reached 2^64 - 1
    std::uint64_t outside_positions = 0;  ///< vertices outside the tree's cube

    void add(const UpdateCaps& other);
    bool operator==(const UpdateCaps&) const = default;
};

/// Dense sums over the cells and regions of one tree, exact integers: adding is order-free and split == whole.
class TreeSums {
  public:
    TreeSums() = default;
    /// Mixture histograms only `with_mixture`: they take kMixtureBins more sums per region.
    TreeSums(std::uint32_t pass, std::uint32_t regions, std::uint32_t cells, bool with_mixture = false);

    std::uint32_t pass() const { return pass_; }
    const std::vector<std::uint64_t>& cells() const { return cells_; }
    /// Recorded vertices per region, those without radiance included.
    const std::vector<std::uint64_t>& counts() const { return counts_; }
    /// Bin b of region r is at r * kMixtureBins + b; empty where no mixture is learned.
    const std::vector<std::uint64_t>& mixture() const { return mixture_; }
    const UpdateCaps& caps() const { return caps_; }

    void add_count(std::uint32_t region, std::uint64_t count) { counts_[region] += count; }
    /// Adds to one cell; false where the sum would pass 2^64 - 1 and stays there (the caller counts it).
    bool add_quanta(std::uint32_t cell, std::uint64_t quanta);
    bool add_mixture(std::uint32_t region, std::uint8_t bin, std::uint64_t quanta);
    void add_caps(const UpdateCaps& caps) { caps_.add(caps); }
    void add(const TreeSums& other);
    void clear();

    /// Sparse form: only cells and counts that are not zero (docs/protocol.md, "tree update").
    Bytes encode() const;
    /// Adds an encoded update, checking pass, order and range of every entry before anything is added; FormatError
    /// otherwise. Returns the number of touched cells.
    std::uint64_t merge_encoded(std::span<const std::uint8_t> update);

    bool operator==(const TreeSums&) const = default;

  private:
    std::uint32_t pass_ = 0;
    std::vector<std::uint64_t> cells_;
    std::vector<std::uint64_t> counts_;
    std::vector<std::uint64_t> mixture_;
    UpdateCaps caps_;
};

/// value / 2^exponent as an integer, rounded up with the probability of its fraction, so that the expectation is exact.
/// Above 2^40 quanta it is capped and `capped` is raised.
std::uint64_t quantise(float value, int exponent, std::uint32_t random, bool& capped);

}  // namespace treefarm
