// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/base/bytes.h"
#include "common/base/random.h"
#include "common/film/pixel_estimate.h"

namespace treefarm {

/// Splat: the contribution of a path to a pixel that it did not start from, v = f / p with respect to the whole film.
/// The image is the sum of v over n, the number of paths per pixel. Splats are summed as integers, in quanta of
/// 2^exponent, so that any order gives the same bits (docs/design/error.md, "splats").

/// Limit of a quantum's exponent, either sign: splats and their squares stay far from the ends of double.
inline constexpr int kMostSplatExponent = 256;

/// Format of the splat sums of a pass.
struct SplatShape {
    std::uint32_t pixels = 0;   ///< of the film; 0: the pass has no splats
    std::int16_t exponent = 0;  ///< of the quantum, within +-kMostSplatExponent
    /// Whether the splats are of Markov chains. Splats of one chain depend on each other, so squares are of a whole
    /// chain's contribution to a pixel.
    bool chains = false;

    bool operator==(const SplatShape&) const = default;
};

/// Exponent of the quantum for splats whose mean, above zero, is known from an earlier pass: the mean is 2^10 to 2^11
/// quanta.
std::int16_t splat_exponent(double mean);

/// Counts of splats that were changed or refused; none is dropped silently.
struct SplatCaps {
    std::uint64_t capped = 0;    ///< above 2^40 quanta, reduced to that: the pixel is too dark
    std::uint64_t rejected = 0;  ///< NaN, infinite or negative

    void add(const SplatCaps& other);
    bool operator==(const SplatCaps&) const = default;
};

/// Log2 of squared quanta per unit of squares: the mean splat's square is one to four units.
inline constexpr int kSquareBits = 20;

/// Splat sums of one half of a pixel.
struct SplatMoments {
    std::array<std::uint64_t, 3> sum{};  ///< quanta of v
    std::array<std::uint64_t, 3>
        square{};  ///< of v^2, or of a chain's sum squared, in units of 2^(2 exponent + kSquareBits)

    void add(const SplatMoments& other);  ///< saturates at kMostSplatSum
    bool empty() const;
    bool operator==(const SplatMoments&) const = default;
};

/// Limit of a sum. min(sum, limit) does not depend on the order of additions.
inline constexpr std::uint64_t kMostSplatSum = std::uint64_t{1} << 63;

/// Splats of one work unit. Each thread reuses one log, and its memory, for all units.
class SplatLog {
  public:
    struct Entry {
        std::uint64_t slot;  ///< pixel * 2 + half
        SplatMoments moments;
    };

    /// Empties the log.
    void begin(const SplatShape& shape);
    /// Adds a splat. `sample`: index of the path's sample, or of the chain, which selects the half; `bits`: keyed
    /// random numbers for stochastic rounding. Zero splats may be left out.
    void add(std::uint32_t pixel, std::uint32_t sample, const Rgb& value, const Draw& bits);
    /// Ends a chain: later splats belong to another one. Squares are those of batch means (docs/design/error.md,
    /// "splats").
    void end_chain();
    /// The splats, one entry per slot, in order of slots; ends a chain.
    std::span<const Entry> summed();
    bool empty() const { return all_.entries.empty() && chain_.entries.empty() && caps_ == SplatCaps{}; }
    const SplatCaps& caps() const { return caps_; }

  private:
    struct SummedEntries {
        std::vector<Entry> entries;
        std::size_t summed = 0;        ///< entries before this one are in order, one per slot
        std::size_t summing_size = 0;  ///< number of entries that triggers summing

        void clear();
        void push(const Entry& entry);
        void sum_up();
    };

    SplatShape shape_;
    double per_value_ = 1;
    SummedEntries all_, chain_;  ///< the current chain has sums only
    SplatCaps caps_;
};

/// Splat sums over the film of one pass, 96 bytes per pixel.
class SplatSums {
  public:
    SplatSums() = default;  ///< of a pass without splats: no memory
    explicit SplatSums(const SplatShape& shape);

    const SplatShape& shape() const { return shape_; }
    const SplatMoments& at(std::size_t pixel, std::size_t half) const { return moments_[2 * pixel + half]; }
    const SplatCaps& caps() const { return caps_; }
    /// Number of sums at their limit, each of which makes a pixel too dark. Counted by this call.
    std::uint64_t saturated() const;

    /// Adds entries. Throws RunError for a pixel outside the film, before any change.
    void add(std::span<const SplatLog::Entry> entries, const SplatCaps& caps);
    void clear();

    /// Sparse form: pixels with splats (docs/design/protocol.md, "splats").
    Bytes encode() const;
    /// Throws FormatError unless encode() of this film can have written the bytes.
    void check(std::span<const std::uint8_t> encoded) const;
    /// Adds an encoded part after check().
    void merge_encoded(std::span<const std::uint8_t> encoded);

    bool operator==(const SplatSums&) const = default;

  private:
    SplatShape shape_;
    std::vector<SplatMoments> moments_;  ///< two per pixel, by SplatLog::Entry::slot
    SplatCaps caps_;
};

}  // namespace treefarm
