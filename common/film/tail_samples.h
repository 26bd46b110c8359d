// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/film/light_origin.h"
#include "common/film/pixel_estimate.h"

namespace treefarm {

/// A sample that makes up much of its pixel's noise (a firefly), with the origin of its light.
struct TailSample {
    float noise = 0;  ///< contribution to the variance of the pixel's mean (luminance)
    std::uint32_t pass = 0;
    std::uint16_t x = 0, y = 0;
    std::uint32_t sample = 0;  ///< index within the pass
    LightOrigin origin;

    bool operator==(const TailSample&) const = default;
};

/// Total order of samples: more noise first, then by pixel and index.
bool comes_before(const TailSample& a, const TailSample& b);

/// Noise due to the largest sample of a pixel with `spp` samples in the pass; `pixel` holds the samples so far. 0
/// unless it is a large part of the pixel's variance (kPolicy.tails.outlier): a directly visible lamp has no noise, and
/// if all samples differ alike, none is an outlier.
float outlier_noise(const Rgb& value, const Moments& pixel, std::uint32_t spp);

/// The noisiest samples. Depends only on the set of added samples, not on their order.
struct TailSamples {
    static constexpr std::size_t kMost = 8;
    std::vector<TailSample> worst;  ///< ordered by comes_before(); at most kMost

    void add(const TailSample& sample);
    void add(const TailSamples& other);
    bool operator==(const TailSamples&) const = default;
};

}  // namespace treefarm
