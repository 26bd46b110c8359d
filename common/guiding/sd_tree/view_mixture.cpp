// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree/view_mixture.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/base/error.h"
#include "common/base/policy.h"

namespace treefarm {
double view_gain(const MixtureHistogram& histogram, double others) {
    const double whole = histogram_total(histogram);
    if (!(whole > 0)) return 0;
    double sum = 0;
    for (int b = 0; b < kMixtureBins; ++b) {
        const double r = mixture_bin_centre(b);
        sum += histogram[static_cast<std::size_t>(b)] * std::log(others + (1.0 - others) * (1.0 - r) / r);
    }
    return sum / whole;
}

std::vector<ViewAdvice> ViewLearner::judge(const SdTree& tree, const CellSums& sums, bool last_update) {
    const std::uint32_t regions = tree.region_count(), views = tree.view_count();
    if (sums.shape() != SumsShape(regions, tree.cell_count(), true, views, !tree.light_probabilities.empty(), false,
                                  tree.decides_next_event()))
        throw RunError("the sums to learn the mixture from belong to another tree");
    views_.resize(views);
    std::vector<ViewAdvice> advice(views);
    const double all_records = std::accumulate(sums.counts().begin(), sums.counts().begin() + regions, 0.0);
    std::vector<bool> idle(views);
    double gain_of_all = 0;
    for (std::uint32_t v = 0; v < views; ++v) {
        const std::uint32_t distribution = regions + v;
        Evidence& evidence = views_[v];
        const std::uint64_t records = sums.counts()[distribution];
        const double prior = 1.0 - static_cast<double>(tree.view_fraction[v]);
        const double others = learn_fraction(evidence.histogram, sums.mixture(distribution),
                                             tree.quantum_exponent[distribution], records, prior);
        if (histogram_total(evidence.histogram) > 0) evidence.others = others;
        const double gain = std::max(0.0, view_gain(evidence.histogram, evidence.others));
        idle[v] = 1.0 - evidence.others < tuned("learning.idle_fraction") || gain < tuned("learning.least_view_gain");
        advice[v].gain = static_cast<double>(records) * gain;
        if (!idle[v]) gain_of_all += advice[v].gain;
    }
    const bool all_idle = gain_of_all < tuned("learning.least_view_gain_of_all") * all_records;
    for (std::uint32_t v = 0; v < views; ++v) {
        int& idle_passes = views_[v].idle_passes;
        idle_passes = idle[v] || all_idle ? idle_passes + 1 : 0;
        advice[v].keep = idle_passes < (last_update ? 1 : tuned<int>("learning.idle_passes"));
    }
    return advice;
}

void ViewLearner::set_fractions(std::span<const ViewOrigin> origins, SdTree& next) {
    std::vector<Evidence> inherited;
    inherited.reserve(origins.size());
    for (std::size_t v = 0; v < origins.size(); ++v) {
        inherited.push_back(views_[origins[v].view]);
        Evidence& evidence = inherited.back();
        for (double& h : evidence.histogram)
            h = std::ldexp(h, -origins[v].halvings);
        next.view_fraction[v] =
            std::min(static_cast<float>(1.0 - evidence.others), 1.0f - next.bsdf_fraction[next.region_count() + v]);
    }
    views_ = std::move(inherited);
}

}  // namespace treefarm
