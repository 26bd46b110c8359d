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

/// What a work unit, or a pass, gives for AOVs besides its pixels.
struct AovPixels {
    std::vector<double> values;         ///< pixel by pixel, as the layout says
    std::vector<PixelEstimate> direct;  ///< the part of each pixel that is direct light; empty where nobody asks
};

/// Reduces the numbers of a pixel's consecutive aligned blocks, one row of AovLayout::size() after the other, along the
/// tree of reduce_blocks(); the result is the first row.
void reduce_aov_blocks(const AovLayout& layout, std::span<double> blocks);

/// The AOVs of one pass: takes work units in any order and gives the same bits.
class AovFilm {
  public:
    AovFilm(const AovLayout& layout, int width, int height, std::uint32_t chunks);

    /// Throws FormatError where what a unit gives is not of its size, or no finite number.
    void check(const WorkUnit& unit, const AovPixels& pixels) const;
    /// Adds what check() lets pass of a unit that fits the film; each pixel and chunk once.
    void add(const WorkUnit& unit, const AovPixels& pixels);
    /// What has come, as PassFilm::encode(); restore() likewise.
    Bytes encode(const DoneWork& done) const;
    void restore(const DoneWork& done, std::span<const std::uint8_t> bytes);
    /// Everything, once the film is complete.
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
    std::unordered_map<std::uint32_t, Pending> pending_;  ///< by pixel: those not yet whole
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

    /// Adds a pass of `spp` samples per pixel; in the order of the passes, since sums round.
    void add(const AovPixels& pass, std::uint32_t spp);
    /// The channels asked for. `image` is made of `passes`.
    std::vector<AovChannel> channels(const CombinedImage& image, std::span<const PassResult> passes) const;

    bool requested() const { return !requests_.empty(); }
    /// Whether the sums are of the pixels and AovRequests that they were made for: those that were read may not be.
    bool fits() const {
        return values_.size() == layout_.size() * pixel_count_ &&
               direct_.size() == (layout_.direct() ? pixel_count_ : 0);
    }

    /// Lists what it remembers, for a checkpoint.
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
