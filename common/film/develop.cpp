// SPDX-License-Identifier: Apache-2.0
#include "common/film/develop.h"

#include <algorithm>
#include <cmath>

#include "common/base/parallel.h"

namespace treefarm {
namespace {

/// Least number of pixels per thread.
constexpr std::size_t kLeastDeveloped = 4096;

/// Adds the splats of a half of a pixel. `paths`: number of the half's paths, or samples, at least one; for Markov
/// chains the half must have two chains.
void add_splats(Moments& pixel, const SplatMoments& splats, const SplatShape& shape, std::uint32_t paths,
                std::uint32_t chains) {
    const double n = paths, samples = pixel.n;
    const double quantum = std::ldexp(1.0, shape.exponent) / n,
                 square = std::ldexp(1.0, 2 * shape.exponent + kSquareBits) / (n * n);
    for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        const double mean = static_cast<double>(splats.sum[k]) * quantum;
        // Splats are so rare in a pixel that their number is Poisson-distributed: the sum of squares is the variance of
        // the sum.
        double variance = static_cast<double>(splats.square[k]) * square;
        // Chains are independent: the deviations of their sums are those of the total.
        if (shape.chains) variance = std::max(0.0, (variance * chains - mean * mean) / (chains - 1.0));
        pixel.mean[c] += mean;
        pixel.m2[c] += variance * (samples * (samples - 1));
    }
}

}  // namespace

HalfCounts half_counts(std::uint64_t first, std::uint32_t count) {
    const auto even = static_cast<std::uint32_t>((std::uint64_t{count} + 1 - first % 2) / 2);
    return {even, count - even};
}

std::vector<PixelEstimate> develop(std::vector<PixelEstimate> estimates, const SplatSums& splats,
                                   const HalfCounts& paths, const HalfCounts& chains) {
    const SplatShape& shape = splats.shape();
    if (shape.pixels == 0) return estimates;
    if (estimates.empty()) {
        PixelEstimate blank;
        for (std::size_t half = 0; half < 2; ++half)
            blank.half[half].n = paths[half];
        estimates.assign(shape.pixels, blank);
    }
    in_parts(estimates.size(), kLeastDeveloped, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            for (std::size_t half = 0; half < 2; ++half) {
                Moments& pixel = estimates[p].half[half];
                if (pixel.n == 0 || paths[half] == 0 || (shape.chains && chains[half] < 2))
                    pixel = {};
                else
                    add_splats(pixel, splats.at(p, half), shape, paths[half], chains[half]);
            }
    });
    return estimates;
}

}  // namespace treefarm
