// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "common/film/tail_samples.h"

namespace treefarm {

/// Search for the unit's sample that contributes most noise, among the largest of each pixel: one comparison per
/// sample.
class WorstSample {
  public:
    /// Adds a sample of the present pixel.
    void see(const Rgb& value, std::uint32_t sample) {
        const float light = std::abs(luminance(value));
        if (!(light > largest_light_)) return;
        largest_light_ = light;
        largest_ = value;
        number_ = sample;
    }

    /// Ends the present pixel, which had `spp` samples.
    void finish(std::uint32_t pass, int x, int y, const PixelEstimate& pixel, std::uint32_t spp) {
        const TailSample sample{outlier_noise(largest_, pixel.whole(), spp),
                                pass,
                                static_cast<std::uint16_t>(x),
                                static_cast<std::uint16_t>(y),
                                number_,
                                {}};
        if (sample.noise > 0.0f && (!found() || comes_before(sample, worst_))) {
            worst_ = sample;
            value_ = largest_;
        }
        largest_ = Rgb(0.0f);
        largest_light_ = 0.0f;
        number_ = 0;
    }

    bool found() const { return worst_.noise > 0.0f; }
    const TailSample& worst() const { return worst_; }
    /// Value of the worst sample, as its pixel received it.
    const Rgb& value() const { return value_; }

  private:
    float largest_light_ = 0.0f;
    std::uint32_t number_ = 0;
    Rgb largest_{0.0f}, value_{0.0f};
    TailSample worst_;
};

}  // namespace treefarm
