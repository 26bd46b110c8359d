// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/film/aov.h"
#include "common/film/combine.h"
#include "common/film/pass_film.h"

namespace treefarm {

/// AOVs of a work unit or a pass, beside its pixel estimates.
struct AovPixels {
    std::vector<double> values;         ///< pixel by pixel, in the order of AovLayout
    std::vector<PixelEstimate> direct;  ///< direct light of each pixel; empty unless requested
};

/// Reduces the numbers of a pixel's consecutive aligned blocks, one row of AovLayout::size() numbers per block, along
/// the tree of reduce_blocks(); the result is in the first row.
void reduce_aov_blocks(const AovLayout& layout, std::span<double> blocks);

/// The AOVs of one pass. Work units may come in any order; the result has the same bits.
class AovFilm {
  public:
    AovFilm(const AovLayout& layout, int width, int height, std::uint32_t chunks);

    /// Throws FormatError unless the AOVs of a unit have its size, and numbers that `samples` samples a pixel may have;
    /// `is_signed`: the filter has negative lobes.
    void check(const WorkUnit& unit, const AovPixels& pixels, std::uint32_t samples, bool is_signed) const;
    /// Adds the AOVs of a unit, after check(); each pixel and chunk once.
    void add(const WorkUnit& unit, const AovPixels& pixels);
    /// The state as bytes, as PassFilm::encode(); restore() likewise.
    Bytes encode(const DoneWork& done) const;
    void restore(const DoneWork& done, std::span<const std::uint8_t> bytes);
    /// The AOVs of the complete film, moved out.
    AovPixels take();

  private:
    struct Pending {
        std::vector<double> chunks;  ///< a row each
        std::uint32_t arrived = 0;
    };

    AovLayout layout_;
    int width_;
    std::uint32_t chunks_;
    std::vector<double> values_;
    std::unordered_map<std::uint32_t, Pending> pending_;  ///< pixels that lack chunks, by index
    PassFilm direct_;
};

/// A channel of the file.
struct AovChannel {
    std::string name;
    bool precise = false;  ///< AovKind::precise
    std::vector<float> values;
};

/// The AOVs of all passes so far.
class AovSums {
  public:
    AovSums() : AovSums({}, 0) {}
    AovSums(std::span<const AovRequest> requests, std::size_t pixel_count);

    /// Adds a pass of `spp` samples per pixel. The order of passes matters, since sums round.
    void add(const AovPixels& pass, std::uint32_t spp);
    /// The requested channels. `image`: the combination of `passes`.
    std::vector<AovChannel> channels(const CombinedImage& image, std::span<const PassResult> passes) const;

    bool requested() const { return !requests_.empty(); }
    /// Whether the sums match the pixels and requests of this object; sums that were read from a file may not.
    bool fits() const {
        return values_.size() == layout_.size() * pixel_count_ &&
               direct_.size() == (layout_.direct() ? pixel_count_ : 0);
    }

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(spp_, values_, direct_);
    }

  private:
    void develop(Aov aov, std::uint32_t component, const CombinedImage& image, std::span<const PassResult> passes,
                 std::vector<float>& out) const;

    std::vector<AovRequest> requests_;
    AovLayout layout_;
    std::size_t pixel_count_;
    std::uint64_t spp_ = 0;
    std::vector<double> values_;
    std::vector<Rgb64> direct_;  ///< sums over samples
};

}  // namespace treefarm
