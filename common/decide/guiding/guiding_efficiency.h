// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/decide/pixels/image_levels.h"
#include "common/evidence/block_shape.h"

namespace treefarm {

/// Integer sums over pixel groups that compare unguided with guided sampling, from guided samples alone: each of these
/// also estimates the noise and the cost of unguided ones (worker/integrators/path/unguided_estimate.h).
struct UnguidedSums {
    static constexpr std::size_t kGroups = 64;
    static constexpr double kMomentUnit = 0x1p-16, kCostUnit = 0x1p-8;

    std::array<std::uint64_t, kGroups> guided{},
        unguided{};          ///< second moments of samples, relative to the squared level
    std::uint64_t cost = 0;  ///< of unguided samples, in rays

    static constexpr BlockShape kBlock{"unguided", "kMomentUnit, kCostUnit", BlockKind::sums, 1, 2 * kGroups + 1};
    template <class Sums, class Visit>
    static constexpr void each(Sums& sums, Visit visit) {
        for (auto* const moments : {&sums.guided, &sums.unguided})
            for (auto& moment : *moments)
                visit(moment);
        visit(sums.cost);
    }
    void add(const UnguidedSums& other);
};

/// Group of a pixel, a hash of its coordinates.
constexpr std::size_t pixel_group(std::uint32_t x, std::uint32_t y) {
    return (x * 0x9e3779b9u ^ y * 0x85ebca6bu) * 0xc2b2ae35u >> 26;
}

/// Sums of the samples of a pixel's block in sample order, rounded to integers at the block's end.
class UnguidedBlock {
  public:
    /// Adds a guided sample: its luminance over the level, and its estimates for unguided samples (cost in rays).
    void add(double guided, double unguided_moment, double unguided_cost) {
        guided_ += guided * guided;
        unguided_ += unguided_moment;
        cost_ += unguided_cost;
    }
    /// Adds the block's sums to those of a group and resets them.
    void finish(std::size_t group, UnguidedSums& sums);

  private:
    double guided_ = 0, unguided_ = 0, cost_ = 0;
};

/// Efficiency of guiding: variance times cost of unguided samples over that of guided ones. Above 1 guiding pays.
struct GuidingEfficiency {
    double efficiency = 0;                              ///< 0: unknown
    double error = 0;                                   ///< standard error of the logarithm of `efficiency`
    double known = 0;                                   ///< effective number of pixel groups behind the estimate
    double unguided_variance = 0, guided_variance = 0;  ///< of one sample
    double unguided_cost = 0, guided_cost = 0;          ///< of one sample, in rays

    double low() const;  ///< one standard error below
    double high() const;

    bool operator==(const GuidingEfficiency&) const = default;

    template <class Archive>
    void serialize(Archive& archive) {
        archive(efficiency, error, known, unguided_variance, guided_variance, unguided_cost, guided_cost);
    }
};

/// Variances and costs of guided and unguided samples, by pixel group, from guided passes.
struct GuidingEvidence {
    using Groups = std::array<double, UnguidedSums::kGroups>;

    double samples = 0;           ///< per pixel; 0: no data
    Groups guided{}, unguided{};  ///< variances of one sample; the sum over groups is that of a mean pixel
    double guided_cost = 0, unguided_cost = 0;  ///< of one sample, in rays

    /// Adds the evidence of other passes; all samples weigh the same.
    void add(const GuidingEvidence& other);
    GuidingEfficiency efficiency() const;

    bool operator==(const GuidingEvidence&) const = default;

    template <class Archive>
    void serialize(Archive& archive) {
        archive(samples, guided, unguided, guided_cost, unguided_cost);
    }
};

/// Evidence of a guided pass with these pixels. `guided_cost`: rays per sample.
GuidingEvidence guiding_evidence(const UnguidedSums& sums, std::span<const PixelEstimate> pixels,
                                 const ImageLevels& levels, std::size_t width, double guided_cost);

}  // namespace treefarm
