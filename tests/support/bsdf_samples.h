// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "common/base/random.h"
#include "worker/shading/bsdf.h"

namespace treefarm::test {

/// Random numbers number i for a BSDF.
inline BsdfRandom uniform(std::uint32_t i) {
    const Draw r = draw({13, i, 0}, 0, Stream::scatter);
    return {to_unit(r[1]), {to_unit(r[2]), to_unit(r[3])}};
}

/// Direction with this cosine and azimuth.
inline Vec3 at_cosine(float cos, float azimuth) {
    const float sin = std::sqrt(std::max(0.0f, 1.0f - cos * cos));
    return Vec3(sin * std::cos(azimuth), sin * std::sin(azimuth), cos);
}

/// Mean fraction of the power that a sample carries on, with the scaling of radiance undone.
inline double mean_power(const Bsdf& bsdf, const Vec3& wo, int samples) {
    const double eta2 = double(refraction_of(bsdf)) * double(refraction_of(bsdf));
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        const BsdfSample s = bsdf.sample(wo, uniform(static_cast<std::uint32_t>(i)));
        if (!(s.pdf > 0.0f)) continue;
        EXPECT_TRUE(is_finite(s.f_cos) && std::isfinite(s.pdf) && is_finite(s.wi));
        EXPECT_NEAR(s.wi.length(), 1.0f, 3e-6f);
        sum += double(s.f_cos.y) / double(s.pdf) * (s.wi.z < 0.0f ? eta2 : 1.0);
    }
    return sum / samples;
}

}  // namespace treefarm::test
