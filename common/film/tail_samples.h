// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/film/light_origin.h"
#include "common/film/pixel_estimate.h"

namespace treefarm {

/// A sample that is much of its pixel's noise: a firefly, with where its light comes from.
struct TailSample {
    float noise = 0;  ///< what it alone adds to the variance of its pixel's mean (luminance)
    std::uint32_t pass = 0;
    std::uint16_t x = 0, y = 0;
    std::uint32_t sample = 0;  ///< within the pass
    LightOrigin origin;

    bool operator==(const TailSample&) const = default;
};

/// A total order of samples: more noise first, then by place.
bool comes_before(const TailSample& a, const TailSample& b);

/// Noise of the largest sample of a pixel that has `spp` in the pass; `pixel` are those that are known. 0 unless it is
/// a quarter of the pixel's variance: a lamp seen directly has no noise, and where all
/// samples differ alike none of them is to blame.
float outlier_noise(const Rgb& value, const Moments& pixel, std::uint32_t spp);

/// The samples of the most noise. A function of the set of what is added: any order gives the same.
struct TailSamples {
    static constexpr std::size_t kMost = 8;
    std::vector<TailSample> worst;  ///< by comes_before(); at most kMost

    void add(const TailSample& sample);
    void add(const TailSamples& other);
    bool operator==(const TailSamples&) const = default;
};

}  // namespace treefarm
