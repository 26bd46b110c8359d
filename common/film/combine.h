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
    std::optional<double>
        variance;  ///< of one sample: mean over pixels of its luminance; empty if no pixel has two samples
    std::vector<std::uint32_t> samples;  ///< of a pixel, in each pass
};

/// Noise, by halves, of `passes` consecutive passes that are alike (one tree, one way of sampling emitters).
struct SampleNoise {
    std::size_t passes = 0;  ///< 0: not measured
    std::array<HalfNoise, 2> half;
};

/// Length of an original pass within a merged one.
struct PassPart {
    std::uint32_t spp = 0, spp_before = 0;
};

/// A finished pass, or several neighbours merged into one (fold_passes.h).
struct PassResult {
    std::uint32_t spp = 0;              ///< n_k, samples per pixel
    std::uint32_t spp_before = 0;       ///< N_k, samples per pixel of all passes before
    std::vector<PixelEstimate> pixels;  ///< row by row
    bool same_tree = false;             ///< as the pass before it
    bool new_technique = false;         ///< next event started or stopped with this pass
    bool guided = true;                 ///< false after guiding was given up
    SampleNoise noise{};                ///< of this pass and those after it that are alike (remember_noise)
    std::vector<PassPart> parts{};      ///< original passes of a merged one; empty otherwise
    std::string stored{};               ///< checkpoint file that holds these pixels; "": none
};

/// The combined image, with its estimated error.
struct CombinedImage {
    std::vector<Rgb64> mean;         ///< per pixel
    std::vector<Rgb64> variance;     ///< estimated variance of `mean`, per pixel and channel
    std::uint32_t longest_pass = 0;  ///< of the longest pass, in samples per pixel; variances exist from two on
    std::vector<Rgb64> half[2];      ///< two independent halves; `mean` is their average where both exist
    std::vector<double> weight;      ///< of each pass, merged ones included; sums to 1 (mean of both halves)
};

/// Combines passes with one scalar weight each (docs/design/error.md, "combining passes"). `guided`: whether the
/// quality of passes differs; without guiding all samples weigh the same. `last` uses only the passes of the last tree.
CombinedImage combine_passes(std::span<const PassResult> passes, Combination method, bool guided);

/// Measures the noise of passes as combine_passes() would, and stores it in them; to be called after each pass, so that
/// old passes are not measured again. Code that changes a pass must clear its noise and its `stored`.
void remember_noise(std::span<PassResult> passes, Combination method, bool guided);

/// Weight of a pass that is known before it begins (`fixed`): spp sqrt(spp_before); without guiding, spp. Not
/// normalised.
double fixed_weight(std::uint32_t spp, std::uint32_t spp_before, bool guided);

/// Variance figures of one pass (docs/design/error.md, "stuv"), from the pixels that it rendered.
struct PassVariance {
    double stuv = 0;           ///< mean over pixels of the luminance of the unbiased variance of one sample
    double stuv_trimmed = 0;   ///< stuv without the worst 0.1 % of the pixels
    double mse_of_sample = 0;  ///< mean over pixels and channels of the unbiased variance of one sample
    double stuv_ppg = 0;       ///< STUV of the authors' program: a clamped second moment
};
PassVariance pass_variance(std::span<const PixelEstimate> pixels);

}  // namespace treefarm
