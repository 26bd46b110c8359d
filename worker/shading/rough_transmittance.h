// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "worker/shading/microfacet.h"

namespace treefarm {

/// Transmittance of a rough dielectric boundary, by the cosine of incidence: single scattering at the facets, as in
/// Mitsuba 0.6's tables, but integrated at scene load by a fixed quadrature over visible normals.
class RoughTransmittance {
  public:
    RoughTransmittance() = default;
    /// `eta`: index of refraction of the far side over that of the side from which light comes.
    RoughTransmittance(const Microfacet& facets, float eta);

    /// Transmittance at a cosine in [0, 1]. always_inline, since the compiler's own choice depends on the number of
    /// callers.
    [[gnu::always_inline]] float at(float cos) const {
        const float position = std::sqrt(cos) * kIntervals;
        const auto i = std::min(static_cast<std::size_t>(position), kIntervals - 1);
        return values_[i] + (values_[i + 1] - values_[i]) * (position - static_cast<float>(i));
    }
    /// Fraction of diffuse light from the far side that leaves for good; `single_return`: only the facets' single
    /// reflection returns (PlasticMaterial::single_return), else all that is not transmitted.
    float escapes(bool single_return) const { return single_return ? escapes_single_ : escapes_all_; }

    /// Interpolation (1 - t) a + t b.
    static RoughTransmittance between(const RoughTransmittance& a, const RoughTransmittance& b, float t);

  private:
    static constexpr std::size_t kIntervals = 64;

    std::array<float, kIntervals + 1> values_{};  ///< at cosines (i / kIntervals)^2
    float escapes_all_ = 1, escapes_single_ = 1;
};

/// Transmittances of boundaries whose roughness varies over a surface.
class RoughTransmittances {
  public:
    RoughTransmittances(bool ggx, float eta);
    /// Transmittance at `alpha`, clamped to the tabulated range, up to 1.
    RoughTransmittance at(float alpha) const;

  private:
    static constexpr int kIntervals = 16;

    std::vector<RoughTransmittance> tables_;  ///< at alpha (i / kIntervals)^2
};

/// Fraction of diffuse light that passes a smooth boundary, from the side of index 1 into eta.
float smooth_diffuse_transmittance(float eta);

}  // namespace treefarm
