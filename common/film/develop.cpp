// SPDX-License-Identifier: Apache-2.0
#include "common/film/develop.h"

#include <cmath>

#include "common/base/parallel.h"

namespace treefarm {
namespace {

/// Pixels that are worth a thread.
constexpr std::size_t kLeastPart = 4096;

/// Adds the splats of a half of a pixel that has so many paths, at least one, and samples.
void add_splats(Moments& pixel, const SplatMoments& splats, int exponent, std::uint32_t paths) {
    const double n = paths, samples = pixel.n;
    const double quantum = std::ldexp(1.0, exponent) / n,
                 square = std::ldexp(1.0, 2 * exponent + kSquareBits) / (n * n);
    for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        pixel.mean[c] += static_cast<double>(splats.sum[k]) * quantum;
        // Splats are so rare in a pixel that their number is Poisson's: the sum of squares is the variance of the sum.
        pixel.m2[c] += static_cast<double>(splats.square[k]) * square * (samples * (samples - 1));
    }
}

}  // namespace

HalfCounts half_counts(std::uint64_t first, std::uint32_t count) {
    const auto even = static_cast<std::uint32_t>((std::uint64_t{count} + 1 - first % 2) / 2);
    return {even, count - even};
}

std::vector<PixelEstimate> develop(std::vector<PixelEstimate> estimates, const SplatSums& splats,
                                   const HalfCounts& paths) {
    if (splats.shape().pixels == 0) return estimates;
    if (estimates.empty()) {
        PixelEstimate blank;
        for (std::size_t half = 0; half < 2; ++half)
            blank.half[half].n = paths[half];
        estimates.assign(splats.shape().pixels, blank);
    }
    in_parts(estimates.size(), kLeastPart, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            for (std::size_t half = 0; half < 2; ++half) {
                Moments& pixel = estimates[p].half[half];
                if (pixel.n == 0 || paths[half] == 0)
                    pixel = {};
                else
                    add_splats(pixel, splats.at(p, half), splats.shape().exponent, paths[half]);
            }
    });
    return estimates;
}

}  // namespace treefarm
