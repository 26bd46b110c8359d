#include "common/guiding/view_mixture.h"

#include <cmath>

#include "common/base/error.h"
#include "common/guiding/mixture.h"

namespace treefarm {
namespace {

/// Of the multiplicative update; it converges slowly where it hardly matters.
constexpr int kSteps = 40;
/// A T2 that deserves less in all its views, so many passes in a row, is released.
constexpr double kIdleFraction = 0.05;
constexpr int kIdlePasses = 2;
/// So does one that gains less, nats per record: what it costs was measured to be worth more (docs/guiding.md,
/// "Views").
constexpr double kLeastGain = 0.2;

/// r_j at the centre of a bin.
ViewFractions centre(int bin) {
    const double bsdf = (bin / kViewSteps + 0.5) / kBsdfSteps, view = (bin % kViewSteps + 0.5) / kViewSteps;
    return {bsdf, (1.0 - bsdf) * (1.0 - view), (1.0 - bsdf) * view};
}

double mixed(const ViewFractions& a, const ViewFractions& r) {
    return a.bsdf * r.bsdf + a.tree * r.tree + a.view * r.view;
}

double total(const ViewMixtureHistogram& histogram) {
    double sum = 0;
    for (const double h : histogram)
        sum += h;
    return sum;
}

/// Mean logarithm of the mixture's density, but for a constant.
double fit(const ViewMixtureHistogram& histogram, const ViewFractions& a) {
    double sum = 0;
    for (int b = 0; b < kViewMixtureBins; ++b) {
        const double h = histogram[static_cast<std::size_t>(b)];
        if (h > 0) sum += h * std::log(mixed(a, centre(b)));
    }
    return sum;
}

/// Raises a_B to its least value at the expense of the others.
ViewFractions bounded(ViewFractions a) {
    if (a.bsdf >= kLeastBsdfFraction) return a;
    const double scale = (1.0 - kLeastBsdfFraction) / (a.tree + a.view);
    return {kLeastBsdfFraction, a.tree * scale, a.view * scale};
}

}  // namespace

ViewFractions best_view_fractions(const ViewMixtureHistogram& histogram, const ViewFractions& prior,
                                  double prior_weight) {
    const double whole = total(histogram) + prior_weight;
    if (!(whole > 0)) return prior;
    ViewFractions a{1.0 / 3, 1.0 / 3, 1.0 / 3};
    for (int step = 0; step < kSteps; ++step) {
        ViewFractions next{prior_weight * prior.bsdf, prior_weight * prior.tree, prior_weight * prior.view};
        for (int b = 0; b < kViewMixtureBins; ++b) {
            const double h = histogram[static_cast<std::size_t>(b)];
            if (h == 0) continue;
            const ViewFractions r = centre(b);
            const double share = h / mixed(a, r);
            next.bsdf += share * a.bsdf * r.bsdf;
            next.tree += share * a.tree * r.tree;
            next.view += share * a.view * r.view;
        }
        a = {next.bsdf / whole, next.tree / whole, next.view / whole};
    }
    return bounded(a);
}

double view_gain(const ViewMixtureHistogram& histogram, const ViewFractions& fractions) {
    const double whole = total(histogram);
    if (!(whole > 0)) return 0;
    // Without T2: two columns of the simplex remain, one fraction to search.
    double low = kLeastBsdfFraction, high = 1.0;
    for (int step = 0; step < 30; ++step) {
        const double a = 0.5 * (low + high);
        double slope = 0;
        for (int b = 0; b < kViewMixtureBins; ++b) {
            const ViewFractions r = centre(b);
            slope += histogram[static_cast<std::size_t>(b)] * (r.bsdf - r.tree) / mixed({a, 1.0 - a, 0}, r);
        }
        (slope > 0 ? low : high) = a;
    }
    const double a = 0.5 * (low + high);
    return (fit(histogram, fractions) - fit(histogram, {a, 1.0 - a, 0})) / whole;
}

std::vector<ViewAdvice> ViewLearner::judge(const SdTree& tree, const TreeSums& sums) {
    const std::uint32_t regions = tree.region_count(), views = tree.view_count();
    if (sums.shape() != SumsShape(regions, tree.cell_count(), true, views, !tree.light_share.empty()))
        throw RunError("the sums to learn the mixture from belong to another tree");
    views_.resize(views);
    std::vector<ViewAdvice> advice(views);
    for (std::uint32_t v = 0; v < views; ++v) {
        const std::uint32_t distribution = regions + v;
        Evidence& evidence = views_[v];
        const auto bins = sums.mixture(distribution);
        double fresh = 0;
        for (std::size_t b = 0; b < kViewMixtureBins; ++b) {
            const double h = std::ldexp(static_cast<double>(bins[b]), tree.quantum_exponent[distribution]);
            evidence.histogram[b] = 0.5 * evidence.histogram[b] + h;
            fresh += h;
        }
        const auto records = static_cast<double>(sums.counts()[distribution]);
        const double mean_record = records > 0 && fresh > 0 ? fresh / records : total(evidence.histogram);
        const auto bsdf = static_cast<double>(tree.bsdf_fraction[distribution]);
        const auto view = static_cast<double>(tree.view_fraction[v]);
        evidence.fractions =
            best_view_fractions(evidence.histogram, {bsdf, 1.0 - bsdf - view, view}, kPriorRecords * mean_record);
        const double gain = std::max(0.0, view_gain(evidence.histogram, evidence.fractions));
        const bool idle = evidence.fractions.view < kIdleFraction || gain < kLeastGain;
        evidence.idle_passes = idle ? evidence.idle_passes + 1 : 0;
        advice[v] = {records * gain, evidence.idle_passes < kIdlePasses};
    }
    return advice;
}

void ViewLearner::hand_down(std::span<const ViewOrigin> origins, SdTree& next) {
    std::vector<Evidence> inherited;
    inherited.reserve(origins.size());
    for (std::size_t v = 0; v < origins.size(); ++v) {
        inherited.push_back(views_[origins[v].view]);
        Evidence& evidence = inherited.back();
        for (double& h : evidence.histogram)
            h = std::ldexp(h, -origins[v].halvings);
        const auto bsdf = static_cast<float>(evidence.fractions.bsdf);
        next.bsdf_fraction[next.region_count() + v] = bsdf;
        next.view_fraction[v] = std::min(static_cast<float>(evidence.fractions.view), 1.0f - bsdf);
    }
    views_ = std::move(inherited);
}

}  // namespace treefarm
