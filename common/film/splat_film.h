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

/// A splat is what one path brings to a pixel that it did not start from: v = f / p against the whole film, so that the
/// image is the sum of v over n, n paths per pixel. Splats are summed as integers, in quanta of 2^exponent: exactly, in
/// any order, to the same bits (docs/design/error.md, "splats").

/// Exponents of quanta that are ever used: splats and their squares are then far from the ends of double.
inline constexpr int kMostSplatExponent = 256;

/// What splats of a pass are summed in.
struct SplatShape {
    std::uint32_t pixels = 0;   ///< of the film; 0: the pass has no splats
    std::int16_t exponent = 0;  ///< of the quantum, within +-kMostSplatExponent
    /// Whether they are of Markov chains: one chain's splats depend on each other, so squares are of what a whole
    /// chain brings to a pixel.
    bool chains = false;

    bool operator==(const SplatShape&) const = default;
};

/// Exponent of the quanta for splats of which an earlier pass had this mean, above zero: it is 2^10 to 2^11 quanta.
std::int16_t splat_exponent(double mean);

/// Splats that are not in the sums as they were. Nothing is dropped silently.
struct SplatCaps {
    std::uint64_t capped = 0;    ///< above 2^40 quanta: the pixel is too dark
    std::uint64_t rejected = 0;  ///< NaN, infinite or negative: the film's door

    void add(const SplatCaps& other);
    bool operator==(const SplatCaps&) const = default;
};

/// Units of squares are coarser than a quantum squared by so many bits: the mean splat's square is one to four.
inline constexpr int kSquareBits = 20;

/// Sums of a half of a pixel's splats.
struct SplatMoments {
    std::array<std::uint64_t, 3> sum{};     ///< quanta of v
    std::array<std::uint64_t, 3> square{};  ///< of v^2, or a chain's, in units of 2^(2 exponent + kSquareBits)

    void add(const SplatMoments& other);  ///< saturates at kMostSplatSum
    bool empty() const;
    bool operator==(const SplatMoments&) const = default;
};

/// Limit of a sum. min(sum, limit) does not depend on the order of what is added either.
inline constexpr std::uint64_t kMostSplatSum = std::uint64_t{1} << 63;

/// Splats of one work unit. A thread keeps one for all of its units: memory is reused.
class SplatLog {
  public:
    struct Entry {
        std::uint64_t slot;  ///< pixel * 2 + half
        SplatMoments moments;
    };

    /// Empties it.
    void begin(const SplatShape& shape);
    /// Adds a splat of a path with this sample number, or of the chain with this number, which says its half; `bits`
    /// are of the keyed generator, for stochastic rounding. Not all zero splats need be added.
    void add(std::uint32_t pixel, std::uint32_t sample, const Rgb& value, const Draw& bits);
    /// The end of a chain: what is added from here on is another's. Squares of batch means (docs/design/error.md,
    /// "splats").
    void end_chain();
    /// What was added, one entry per slot, in their order; ends a chain.
    std::span<const Entry> summed();
    bool empty() const { return all_.entries.empty() && chain_.entries.empty() && caps_ == SplatCaps{}; }
    const SplatCaps& caps() const { return caps_; }

  private:
    struct SummedEntries {
        std::vector<Entry> entries;
        std::size_t summed = 0;        ///< entries before this one are in order, one per slot
        std::size_t summing_size = 0;  ///< entries from which on they are summed up

        void clear();
        void push(const Entry& entry);
        void sum_up();
    };

    SplatShape shape_;
    double per_value_ = 1;
    SummedEntries all_, chain_;  ///< the chain at hand has sums alone
    SplatCaps caps_;
};

/// Sums over the film of one pass, 96 bytes a pixel.
class SplatSums {
  public:
    SplatSums() = default;  ///< of a pass without splats: no memory
    explicit SplatSums(const SplatShape& shape);

    const SplatShape& shape() const { return shape_; }
    const SplatMoments& at(std::size_t pixel, std::size_t half) const { return moments_[2 * pixel + half]; }
    const SplatCaps& caps() const { return caps_; }
    /// Sums that have reached their limit: each makes a pixel too dark. Counted when asked for.
    std::uint64_t saturated() const;

    /// Throws RunError for a pixel beyond the film, before anything is added.
    void add(std::span<const SplatLog::Entry> entries, const SplatCaps& caps);
    void clear();

    /// Sparse form: pixels that were touched (docs/design/protocol.md, "splats").
    Bytes encode() const;
    /// Throws FormatError for what encode() cannot have written for this film.
    void check(std::span<const std::uint8_t> encoded) const;
    /// Adds an encoded part. Checks all of it before anything is added.
    void merge_encoded(std::span<const std::uint8_t> encoded);

    bool operator==(const SplatSums&) const = default;

  private:
    SplatShape shape_;
    std::vector<SplatMoments> moments_;  ///< by slot
    SplatCaps caps_;
};

}  // namespace treefarm
