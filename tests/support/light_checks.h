// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/scene/model/scene.h"

namespace treefarm::test {

/// Holds the directions of sample_direct at p that really reach their light first against the stated density of what
/// rays in those directions meet, by a chi-square test and by the density's integral. Delta lights must be absent.
/// Where a surface is seen at a cosine below `min_cosine` neither counts: the density's pole along the rim of a curved
/// light is beyond quadrature.
void expect_light_distribution(const Scene& scene, const Vec3& p, const std::string& what, float min_cosine = 0.0f);

/// Irradiance (mean of channels) at p on a surface facing n, by sampling the lights alone, and by both lights and
/// cosine with multiple importance sampling; with standard errors. Lights do not shadow each other.
struct Irradiance {
    double light = 0, light_error = 0, both = 0, both_error = 0;
};

Irradiance irradiance(const Scene& scene, const Vec3& p, const Vec3& n, std::uint32_t samples);

void expect_irradiance(const Scene& scene, const Vec3& p, const Vec3& n, double exact, const std::string& what);

}  // namespace treefarm::test
