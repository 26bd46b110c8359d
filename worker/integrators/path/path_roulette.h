// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "worker/integrators/path/path_settings.h"
#include "worker/integrators/path/path_state.h"

namespace treefarm {

/// Exponent of the power of two of a region's radiance, from that of its records, which are L / p or L^2 / p.
inline int radiance_exponent(int record_exponent, GuidingTarget target) {
    return target == GuidingTarget::variance ? record_exponent / 2 : record_exponent;
}

/// Ratio of the light about a path's present vertex to that about its first one, by the mean records of their regions.
template <class G, class Surface>
float brightness(const PathState<G, Surface>& path, const RegionSampler& guide, const PathSettings& settings) {
    if (!settings.roulette.needs_brightness()) return 1.0f;
    const int exponent = guide.quantum_exponent(path.guidance.region) - path.first_exponent;
    return power_of_two(std::clamp(radiance_exponent(exponent, settings.target), -60, 60));
}

/// Number of paths as which a path continues from its present vertex.
template <class G, class Surface>
std::uint32_t splitting(const PathState<G, Surface>& path, const RegionSampler& guide, const PathSettings& settings) {
    if (settings.splitting == 1) return 1;
    const float spread = Surface::kTransmits ? path.spread : 1.0f;
    return settings.roulette.splitting(path.throughput, spread, brightness(path, guide, settings), settings.splitting);
}

/// Probability with which the corresponding unguided path would survive roulette at this vertex.
template <class G, class Surface>
float unguided_survival(const PathState<G, Surface>& path, const PathSettings& settings) {
    const float spread = Surface::kTransmits ? path.spread : 1.0f;
    return settings.unguided_roulette.survival(path.throughput * path.unguided.ratio(), spread);
}

/// Probability that a path survives roulette at its present vertex.
template <bool kGuided, class G, class Surface>
float survival(const PathState<G, Surface>& path, const RegionSampler& guide, const PathSettings& settings) {
    const float spread = Surface::kTransmits ? path.spread : 1.0f;
    if constexpr (!kGuided) return settings.roulette.survival(path.throughput, spread);
    return settings.roulette.survival(path.throughput, spread, brightness(path, guide, settings));
}

}  // namespace treefarm
