// SPDX-License-Identifier: Apache-2.0
#include "common/decide/next_event/next_event_choice.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/decide/next_event/next_event_constants.h"

namespace treefarm {
namespace {

constexpr std::size_t kChoices = kNextEventSamples.size();
constexpr double kLeastRest = 0.02;  ///< of noise and of cost: no decision is believed to take away all

/// Second moment of the region's direct light under a choice, as a sum over the evidence.
double moment(const NextEventEvidence& e, std::size_t choice) {
    return e[kNextEventMoments + choice];
}

double rays(const NextEventEvidence& e, std::size_t choice) {
    const double drawn = e[kNextEventDrawn];
    const double traced = drawn > 0 ? e[kNextEventTraced] / drawn : 1.0;
    return e[kNextEventAsked] * static_cast<double>(kNextEventSamples[choice]) *
           (tuned<policy::kNextEvent>("next_event.sample_cost") +
            tuned<policy::kNextEvent>("next_event.shadow_ray_cost") * traced);
}

/// Standard error of the change in noise from one choice to another.
double doubt(const NextEventEvidence& e, std::size_t from, std::size_t to) {
    const double all = moment(e, kChoices - 1) - moment(e, 0);
    const double part = std::abs(moment(e, to) - moment(e, from));
    return all > 0 ? tuned<policy::kNextEvent>("next_event.standard_errors") * std::sqrt(e[kNextEventSpread]) *
                         std::min(part / all, 1.0)
                   : 0.0;
}

/// Factor on a region's noise and cost after later trees have learned the light that `steps` to fewer light samples
/// leave to them.
double left_by_trees(std::size_t steps) {
    double left = 1.0;
    for (; steps > 0; --steps)
        left *= 1 - tuned<policy::kNextEvent>("next_event.learned");
    return left;
}

/// `credited`: last choice that gets this credit.
std::size_t best_choice(const NextEventEvidence& e, std::size_t now, std::size_t credited, double lambda) {
    const auto price = [&](std::size_t choice) {
        return (moment(e, choice) + lambda * rays(e, choice)) * left_by_trees(std::min(choice, credited));
    };
    std::size_t best = now;
    double least = price(now) * (1 - tuned<policy::kNextEvent>("next_event.least_gain"));
    for (std::size_t choice = 0; choice < kChoices; ++choice) {
        if (choice == now) continue;
        const double cost = price(choice) + (choice > now ? doubt(e, now, choice) : 0.0);
        if (cost < least) {
            least = cost;
            best = choice;
        }
    }
    return best;
}

}  // namespace

void add_halved(NextEventEvidence& evidence, std::span<const std::uint64_t> fresh) {
    for (std::size_t i = 0; i < kNextEventSums; ++i)
        evidence[i] = kKeptEvidence * evidence[i] + static_cast<double>(fresh[i]) * next_event_unit(i);
}

NextEventVerdict decide_next_event(std::span<const NextEventEvidence> evidence, double paths,
                                   const NextEventPrice& price, TreesLearn trees, std::span<std::uint8_t> codes) {
    constexpr int kRounds = 8;
    double known = 0;
    for (const NextEventEvidence& e : evidence)
        known += e[kNextEventAsked];
    if (!(price.rays > 0 && price.variance > 0 && paths > 0) ||
        known < tuned<policy::kNextEvent>("next_event.least_vertices"))
        return {};
    const std::vector<std::uint8_t> in_force(codes.begin(), codes.end());
    const auto credited = [&](std::size_t region) -> std::size_t {
        if (trees == TreesLearn::no_more) return in_force[region];
        return trees == TreesLearn::on ? kChoices - 1 : 0;
    };
    double variance = price.variance, cost = price.rays;
    for (int round = 0; round < kRounds; ++round) {
        const double lambda = variance / cost;
        double variance_change = 0, cost_change = 0;
        bool changed = false;
        for (std::size_t r = 0; r < codes.size(); ++r) {
            const NextEventEvidence& e = evidence[r];
            const std::size_t now = codes[r], best = best_choice(e, now, credited(r), lambda);
            if (best == now) continue;
            variance_change += moment(e, best) - moment(e, now);
            cost_change += rays(e, best) - rays(e, now);
            codes[r] = static_cast<std::uint8_t>(best);
            changed = true;
        }
        if (!changed) break;
        // Second moments bound variances from above, so at least a share of the total must come from elsewhere.
        variance = std::max(variance + variance_change / paths, kLeastRest * variance);
        cost = std::max(cost + cost_change / paths, kLeastRest * cost);
    }
    double always_variance = variance, always_cost = cost, asked = 0, low = 0;
    for (std::size_t r = 0; r < codes.size(); ++r) {
        const NextEventEvidence& e = evidence[r];
        asked += e[kNextEventAsked];
        if (codes[r] + 1u == kChoices) low += e[kNextEventAsked];
        always_variance += (moment(e, 0) - moment(e, codes[r])) / paths;
        always_cost += (rays(e, 0) - rays(e, codes[r])) / paths;
    }
    const double always = std::max(always_variance, kLeastRest * variance) * always_cost;
    return {always > 0 ? variance * cost / always : 1.0, asked > 0 ? low / asked : 0.0};
}

NextEventVerdict ImageNextEventLearner::learn(const NextEventSums& sums, const NextEventPrice& price,
                                              std::uint8_t& code) {
    add_halved(evidence_, sums);
    paths_ = kKeptEvidence * paths_ + price.paths;
    return decide_next_event({&evidence_, 1}, paths_, price, TreesLearn::nothing, {&code, 1});
}

}  // namespace treefarm
