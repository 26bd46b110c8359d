// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/film/combine.h"
#include "common/film/trace_stats.h"

namespace treefarm {

/// Whether guiding pays, measured by the render itself: in a few short passes some pixels, chosen by a hash, are
/// rendered unguided. How noisy they are does not change any more, and guided samples of all passes are held against
/// it. They are no part of a guided image: a pixel's weights depend on its place, never on its samples.

/// The pixels that a pass renders unguided: about 2000, but no more than an eighth of the film and no fewer than 1/128;
/// others in each of eight passes.
class ProbePixels {
  public:
    ProbePixels() = default;  ///< none
    ProbePixels(std::size_t film_pixels, std::uint32_t pass);
    /// Whether this pixel (row * width + column) is a probe.
    bool holds(std::uint32_t pixel) const { return pixel * 0x9e3779b9u - first_ < count_; }

  private:
    std::uint32_t first_ = 0, count_ = 0;  ///< of the pixels' hashes
};

/// The unguided pixels of probe passes: too noisy for an image that is guided to its end, but as good as any other
/// where guiding is given up.
class ProbesSetAside {
  public:
    /// Takes the unguided pixels out of a probe pass, the one that will be number `index` among the passes of the
    /// image.
    void take_out(std::span<PixelEstimate> pixels, std::uint32_t pass, std::size_t index);
    /// Follows passes whose neighbours `first` and first + 1 have become one (fold_passes.h).
    void follow_fold(std::size_t first);
    /// Gives the pixels back to their passes, once.
    void put_back(std::span<PassResult> passes);
    /// Whether all are pixels of an image of so many passes and pixels.
    bool fits(std::size_t passes, std::size_t pixels) const;

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(probes_);
    }

  private:
    struct Probe {
        std::size_t index, pixel;
        PixelEstimate estimate;

        template <class Archive>
        void serialize(Archive& archive) {
            archive(index, pixel, estimate);
        }
    };
    std::vector<Probe> probes_;
};

/// Relative variance times cost of unguided samples over that of guided ones: above 1 guiding pays. 0: not known.
struct GuidingGain {
    double all = 0;   ///< without the worst 0.1 % of the pixels
    double bulk = 0;  ///< without the worst 1 %: steadier, but blind to light that few samples find
    /// How much of the light unguided samples find evenly: mean of their pixels relative to their blocks, of each at
    /// most three times as much. Where it is low few samples find the light, and nobody knows how noisy they are.
    double coverage = 0;
};

/// Unguided samples of probe passes, and what they say of the guided ones.
class GuidingProbe {
  public:
    /// A probe pass with all its pixels.
    void add(std::span<const PixelEstimate> pixels, const TraceStats& stats, std::uint32_t pass);

    /// Gain of the guided samples of a pass. `pixels` of the pass, row by row, its probes left out or not; `image` is
    /// the best that is known. Variances are relative to the square of the mean of the pixel's block of 8 x 8 (with a
    /// floor of a tenth of the image's mean), the worst of either kind, one at least, left out. A pixel's own mean
    /// would not do: where few samples find a rare light it is large with their variance, which then looks small.
    GuidingGain gain(std::span<const PixelEstimate> pixels, const TraceStats& stats, std::uint32_t pass,
                     std::span<const Rgb64> image, std::size_t width) const;

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(unguided_, paths_, rays_);
    }

  private:
    struct Unguided {
        std::uint32_t pixel, samples;
        double variance, mean;  ///< of one sample, luminance

        template <class Archive>
        void serialize(Archive& archive) {
            archive(pixel, samples, variance, mean);
        }
    };
    std::vector<Unguided> unguided_;
    std::uint64_t paths_ = 0, rays_ = 0;
};

}  // namespace treefarm
