// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/film/combination.h"
#include "common/film/pixel_estimate.h"

namespace treefarm {

/// Noise of one half of the samples of passes that are alike.
struct HalfNoise {
    std::optional<double> variance;      ///< of one sample: mean of its luminance; nothing if no pixel has two
    std::vector<std::uint32_t> samples;  ///< of a pixel, in each pass
};

/// Noise of so many passes that are alike (they have one tree, and sample emitters in one way), by halves.
struct SampleNoise {
    std::size_t passes = 0;  ///< 0: not measured
    std::array<HalfNoise, 2> half;
};

/// Length of one of several passes that were merged.
struct PassPart {
    std::uint32_t spp = 0, spp_before = 0;
};

/// One finished pass, or several neighbours as one (fold_passes.h).
struct PassResult {
    std::uint32_t spp = 0;              ///< n_k
    std::uint32_t spp_before = 0;       ///< N_k: what had been rendered when the pass began
    std::vector<PixelEstimate> pixels;  ///< row by row
    bool same_tree = false;             ///< as the pass before it
    bool new_technique = false;         ///< next event began or ended with it
    bool guided = true;                 ///< false where guiding has been given up
    SampleNoise noise{};                ///< of the passes from this one on that are alike (remember_noise)
    std::vector<PassPart> parts{};      ///< passes that were merged into this one; none: it is one
    std::string stored{};               ///< file of a checkpoint that holds these pixels; "": none
};

/// The image so far, with its own error.
struct CombinedImage {
    std::vector<Rgb64> mean;         ///< per pixel
    std::vector<Rgb64> variance;     ///< estimated variance of `mean`, per pixel and channel
    std::uint32_t longest_pass = 0;  ///< samples per pixel: variances are known from two on
    std::vector<Rgb64> half[2];      ///< two independent halves; their average is `mean` where both exist
    std::vector<double> weight;      ///< of each pass, merged ones too, sums to 1 (halves averaged)
};

/// Combines the passes with one scalar weight each (docs/design/error.md, "combining passes"). `guided` says whether
/// the passes differ in quality: without guiding every sample weighs the same. `last` keeps the passes of the last
/// tree.
CombinedImage combine_passes(std::span<const PassResult> passes, Combination method, bool guided);

/// Measures the noise of passes where combine_passes() would, if it is not known yet, and keeps it with them. Called
/// after each pass, it would otherwise measure all of them again. Whoever changes a pass forgets its noise, and the
/// file that holds it.
void remember_noise(std::span<PassResult> passes, Combination method, bool guided);

/// Weight of a pass that is set before it begins (`fixed`): spp sqrt(spp_before); without guiding, spp. Not normalised.
double fixed_weight(std::uint32_t spp, std::uint32_t spp_before, bool guided);

/// Figures of one pass (docs/design/error.md, "stuv"), by the pixels that it rendered.
struct PassVariance {
    double stuv = 0;           ///< mean over pixels of the luminance of the unbiased variance of one sample
    double stuv_trimmed = 0;   ///< stuv without the worst 0.1 % of the pixels
    double mse_of_sample = 0;  ///< mean over pixels and channels of the unbiased variance of one sample
    double stuv_ppg = 0;       ///< what the authors' program calls STUV: a clamped second moment
};
PassVariance pass_variance(std::span<const PixelEstimate> pixels);

}  // namespace treefarm
