// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/film/image_levels.h"

namespace treefarm {

/// Whether guiding pays, by the guided samples alone: each of them also tells how noisy and how costly unguided ones
/// would be (worker/integrators/path/unguided_estimate.h). Sums are whole numbers, over groups of pixels.
struct UnguidedSums {
    static constexpr std::size_t kGroups = 64;
    static constexpr double kMomentUnit = 0x1p-16, kCostUnit = 0x1p-8;

    std::array<std::uint64_t, kGroups> guided{}, unguided{};  ///< second moments of samples, over the squared level
    std::uint64_t cost = 0;                                   ///< of unguided samples, in rays

    void add(const UnguidedSums& other);
};

/// The group of a pixel, by its place.
constexpr std::size_t pixel_group(std::uint32_t x, std::uint32_t y) {
    return (x * 0x9e3779b9u ^ y * 0x85ebca6bu) * 0xc2b2ae35u >> 26;
}

/// Collects the samples of a pixel's block, in their order, so that the sums are whole numbers soon.
class UnguidedBlock {
  public:
    /// Luminance over the level of a guided sample, and what it tells of unguided ones.
    void add(double guided, double unguided_moment, double unguided_cost) {
        guided_ += guided * guided;
        unguided_ += unguided_moment;
        cost_ += unguided_cost;
    }
    /// Adds what was collected to the sums of a group, and forgets it.
    void finish(std::size_t group, UnguidedSums& sums);

  private:
    double guided_ = 0, unguided_ = 0, cost_ = 0;
};

/// Variance times cost of unguided samples over that of guided ones: above 1 guiding pays.
struct GuidingEfficiency {
    double efficiency = 0;                              ///< 0: not known
    double error = 0;                                   ///< standard error of its logarithm
    double known = 0;                                   ///< pixel groups that it rests on, as many as would weigh alike
    double unguided_variance = 0, guided_variance = 0;  ///< of a sample
    double unguided_cost = 0, guided_cost = 0;          ///< of a sample, in rays

    double low() const;  ///< by one standard error
    double high() const;

    bool operator==(const GuidingEfficiency&) const = default;
};

/// What guided passes have told of guided and of unguided samples, by pixel group.
struct GuidingEvidence {
    using Groups = std::array<double, UnguidedSums::kGroups>;

    double samples = 0;                         ///< of each pixel; 0: nothing is known
    Groups guided{}, unguided{};                ///< variances of a sample; their sums are those of a mean pixel
    double guided_cost = 0, unguided_cost = 0;  ///< of a sample, in rays

    /// Adds that of other passes; each sample counts alike.
    void add(const GuidingEvidence& other);
    GuidingEfficiency efficiency() const;

    bool operator==(const GuidingEvidence&) const = default;

    template <class Archive>
    void serialize(Archive& archive) {
        archive(samples, guided, unguided, guided_cost, unguided_cost);
    }
};

/// Evidence of a guided pass with these pixels. `guided_cost` in rays, of one sample.
GuidingEvidence guiding_evidence(const UnguidedSums& sums, std::span<const PixelEstimate> pixels,
                                 const ImageLevels& levels, std::size_t width, double guided_cost);

}  // namespace treefarm
