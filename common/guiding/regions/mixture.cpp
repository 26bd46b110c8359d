// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/regions/mixture.h"

#include <cmath>

#include "common/base/error.h"
#include "common/base/policy.h"

namespace treefarm {
double histogram_total(const MixtureHistogram& histogram) {
    double sum = 0;
    for (const double h : histogram)
        sum += h;
    return sum;
}

double best_bsdf_fraction(const MixtureHistogram& histogram, double prior, double prior_weight) {
    const auto slope = [&](double a) {
        double sum = prior_weight * (prior / a - (1.0 - prior) / (1.0 - a));
        for (int b = 0; b < kMixtureBins; ++b) {
            const double r = mixture_bin_centre(b);
            sum += histogram[static_cast<std::size_t>(b)] * (2.0 * r - 1.0) / (a * r + (1.0 - a) * (1.0 - r));
        }
        return sum;
    };
    double low = tuned("learning.least_bsdf_fraction"), high = 1.0;
    for (int step = 0; step < 30; ++step) {
        const double middle = 0.5 * (low + high);
        (slope(middle) > 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double learn_fraction(MixtureHistogram& histogram, std::span<const std::uint64_t> bins, int exponent,
                      std::uint64_t records, double prior) {
    double fresh = 0;
    for (std::size_t b = 0; b < kMixtureBins; ++b) {
        const double h = std::ldexp(static_cast<double>(bins[b]), exponent);
        histogram[b] = kKeptEvidence * histogram[b] + h;
        fresh += h;
    }
    const double mean_record = records > 0 ? fresh / static_cast<double>(records) : 0.0;
    const double prior_weight =
        tuned("learning.mixture_prior_records") * (mean_record > 0 ? mean_record : histogram_total(histogram));
    return prior_weight > 0 ? best_bsdf_fraction(histogram, prior, prior_weight) : prior;
}

void MixtureLearner::learn(const RegionModel& tree, const CellSums& sums, std::span<const RegionOrigin> origins,
                           RegionModel& next) {
    const std::size_t regions = tree.leaf_count();
    if (!sums.shape().with_mixture || sums.shape().regions != regions)
        throw RunError("the sums to learn the mixture from belong to another tree");
    histograms_.resize(regions);
    std::vector<float> fraction(regions);
    for (std::size_t r = 0; r < regions; ++r) {
        fraction[r] = static_cast<float>(learn_fraction(histograms_[r], sums.mixture(static_cast<std::uint32_t>(r)),
                                                        tree.quantum_exponent[r], sums.counts()[r],
                                                        static_cast<double>(tree.bsdf_fraction[r])));
    }
    std::vector<MixtureHistogram> inherited;
    inherited.reserve(origins.size());
    for (const RegionOrigin& origin : origins) {
        next.bsdf_fraction[inherited.size()] = fraction[origin.region];
        inherited.push_back(histograms_[origin.region]);
        for (double& h : inherited.back())
            h = std::ldexp(h, -origin.halvings);
    }
    histograms_ = std::move(inherited);
}

}  // namespace treefarm
