// SPDX-License-Identifier: Apache-2.0
#include "common/film/tail_samples.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace treefarm {
namespace {

constexpr double kOutlier = 0.25;  ///< of a pixel's variance, that a sample makes alone

}  // namespace

bool comes_before(const TailSample& a, const TailSample& b) {
    return std::tuple(b.noise, a.pass, a.y, a.x, a.sample) < std::tuple(a.noise, b.pass, b.y, b.x, b.sample);
}

float outlier_noise(const Rgb& value, const Moments& pixel, std::uint32_t spp) {
    if (pixel.n < 2 || spp < 2) return 0.0f;
    const Rgb64 distance = Rgb64(value) - pixel.mean;
    const double own = luminance(distance * distance);
    // Of few samples each is a large part, not an outlier.
    const double least = std::max(kOutlier, 2.0 / pixel.n);
    if (!(own > 0) || own < least * luminance(pixel.m2)) return 0.0f;
    const double noise = own / (static_cast<double>(spp) * (spp - 1.0));
    constexpr double kLeast = std::numeric_limits<float>::min(), kMost = std::numeric_limits<float>::max();
    return noise < kLeast ? 0.0f : static_cast<float>(std::min(noise, kMost));
}

void TailSamples::add(const TailSample& sample) {
    worst.insert(std::upper_bound(worst.begin(), worst.end(), sample, comes_before), sample);
    if (worst.size() > kMost) worst.pop_back();
}

void TailSamples::add(const TailSamples& other) {
    for (const TailSample& sample : other.worst)
        add(sample);
}

}  // namespace treefarm
