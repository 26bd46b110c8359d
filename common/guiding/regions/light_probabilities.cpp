// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/regions/light_probabilities.h"

#include <cmath>

#include "common/base/error.h"
#include "common/base/policy.h"

namespace treefarm {
namespace {

/// Integers proportional to `parts`, whose sum is 1, with the sum kLightProbabilityOne. The rounding error is added to
/// the entry for the unlearned choice.
LightProbabilities rounded(const std::array<double, kLightClusters + 1>& parts) {
    LightProbabilities probabilities{};
    std::uint32_t rest = kLightProbabilityOne;
    for (std::size_t i = 1; i < probabilities.size(); ++i) {
        probabilities[i] = static_cast<std::uint16_t>(parts[i] * kLightProbabilityOne);
        rest -= probabilities[i];
    }
    probabilities[0] = static_cast<std::uint16_t>(rest);
    return probabilities;
}

}  // namespace

LightProbabilities learned_probabilities(std::span<const double, kLightClusters> moments, double vertices,
                                         const LightProbabilities& prior) {
    double total = 0;
    for (const double m : moments)
        total += std::sqrt(m);
    if (!(total > 0 && std::isfinite(total))) return prior;
    const double trust = vertices / (vertices + tuned("learning.lights_prior_vertices"));
    std::array<double, kLightClusters + 1> parts{};
    for (std::size_t c = 0; c < kLightClusters; ++c)
        parts[c + 1] = trust * (1 - tuned("learning.lights_unlearned")) * std::sqrt(moments[c]) / total +
                       (1 - trust) * double(prior[c + 1]) / kLightProbabilityOne;
    return rounded(parts);
}

void LightLearner::learn(const RegionModel& tree, const CellSums& sums, std::span<const RegionOrigin> origins,
                         RegionModel& next) {
    const std::uint32_t regions = tree.leaf_count();
    if (!sums.shape().with_lights || sums.shape().regions != regions || tree.light_probabilities.size() != regions)
        throw RunError("the sums to learn the choice of emitters from belong to another tree");
    evidence_.resize(regions);
    std::vector<LightProbabilities> learned(regions);
    for (std::uint32_t r = 0; r < regions; ++r) {
        Evidence& evidence = evidence_[r];
        const auto fresh = sums.lights(r);
        for (std::size_t c = 0; c < kLightClusters; ++c)
            evidence.moments[c] =
                kKeptEvidence * evidence.moments[c] +
                std::ldexp(static_cast<double>(fresh[c]), light_sum_exponent(tree.quantum_exponent[r]));
        evidence.vertices = kKeptEvidence * evidence.vertices + static_cast<double>(sums.counts()[r]);
        learned[r] = learned_probabilities(evidence.moments, evidence.vertices, tree.light_probabilities[r]);
    }
    std::vector<Evidence> inherited;
    inherited.reserve(origins.size());
    next.light_probabilities.clear();
    for (const RegionOrigin& origin : origins) {
        next.light_probabilities.push_back(learned[origin.region]);
        inherited.push_back(evidence_[origin.region]);
        for (double& m : inherited.back().moments)
            m = std::ldexp(m, -origin.halvings);
        inherited.back().vertices = std::ldexp(inherited.back().vertices, -origin.halvings);
    }
    evidence_ = std::move(inherited);
}

}  // namespace treefarm
