// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/scene/model/scene.h"

namespace treefarm::test {

/// Compares the directions of sample_direct at p that reach their light first with the stated density of the hits in
/// those directions, by a chi-square test and by the density's integral. Delta lights must be absent. Surfaces seen at
/// a cosine below `min_cosine` are excluded from both: the density's pole along the rim of a curved light is beyond
/// quadrature.
void expect_light_distribution(const Scene& scene, const Vec3& p, const std::string& what, float min_cosine = 0.0f);

/// Irradiance (mean of channels) at p on a surface facing n, by emitter sampling alone, and by emitter and cosine
/// sampling with MIS; with standard errors. Lights do not shadow each other.
struct Irradiance {
    double light = 0, light_error = 0, both = 0, both_error = 0;
};

Irradiance irradiance(const Scene& scene, const Vec3& p, const Vec3& n, std::uint32_t samples);

void expect_irradiance(const Scene& scene, const Vec3& p, const Vec3& n, double exact, const std::string& what);

}  // namespace treefarm::test
