// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/regions/next_event.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/policy.h"

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
           (tuned("next_event.sample_cost") + tuned("next_event.shadow_ray_cost") * traced);
}

/// Standard error of the change in noise from one choice to another.
double doubt(const NextEventEvidence& e, std::size_t from, std::size_t to) {
    const double all = moment(e, kChoices - 1) - moment(e, 0);
    const double part = std::abs(moment(e, to) - moment(e, from));
    return all > 0 ? tuned("next_event.standard_errors") * std::sqrt(e[kNextEventSpread]) * std::min(part / all, 1.0)
                   : 0.0;
}

/// Factor on a region's noise and cost after later trees have learned the light that `steps` to fewer light samples
/// leave to them.
double left_by_trees(std::size_t steps) {
    double left = 1.0;
    for (; steps > 0; --steps)
        left *= 1 - tuned("next_event.learned");
    return left;
}

/// `credited`: last choice that gets this credit.
std::size_t best_choice(const NextEventEvidence& e, std::size_t now, std::size_t credited, double lambda) {
    const auto price = [&](std::size_t choice) {
        return (moment(e, choice) + lambda * rays(e, choice)) * left_by_trees(std::min(choice, credited));
    };
    std::size_t best = now;
    double least = price(now) * (1 - tuned("next_event.least_gain"));
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

void add_halved(NextEventEvidence& evidence, std::span<const std::uint64_t> fresh) {
    for (std::size_t i = 0; i < kNextEventSums; ++i)
        evidence[i] = kKeptEvidence * evidence[i] + static_cast<double>(fresh[i]) * next_event_unit(i);
}

/// Means over the vertices of a cube, and the variance of the known d (last moment minus the first).
struct VertexMeans {
    NextEventEvidence mean{};
    double variance = 0;
};

/// Pooling of evidence: regions with few vertices use the means of the enclosing cubes.
class Pooling {
  public:
    Pooling(const RegionModel& tree, std::span<const NextEventEvidence> evidence)
        : tree_(tree), evidence_(evidence), sums_(tree.nodes.size()), pooled_(evidence.size()) {
        add_up(0);
        if (const double vertices = sums_[0][kNextEventAsked]; vertices > 0) propagate(0, means_of(sums_[0], vertices));
    }
    std::vector<NextEventEvidence> take() { return std::move(pooled_); }

  private:
    static VertexMeans means_of(const NextEventEvidence& sums, double vertices) {
        VertexMeans means{sums, 0.0};
        for (double& mean : means.mean)
            mean /= vertices;
        means.variance = means.mean[kNextEventSpread] / vertices;
        return means;
    }

    const NextEventEvidence& add_up(std::uint32_t node) {
        const RegionModel::Node& n = tree_.nodes[node];
        if (n.is_leaf()) return sums_[node] = evidence_[n.child[1]];
        for (const std::uint32_t child : n.child) {
            const NextEventEvidence below = add_up(child);
            for (std::size_t i = 0; i < kNextEventSums; ++i)
                sums_[node][i] += below[i];
        }
        return sums_[node];
    }

    /// `about`: means of the cube that the node's cube is a half of; for the root its own.
    void propagate(std::uint32_t node, const VertexMeans& about) {
        const double lent = tuned("next_event.lent_vertices");
        const double own = sums_[node][kNextEventAsked];
        VertexMeans means = about;
        for (std::size_t i = 0; i < kNextEventSums; ++i)
            means.mean[i] = (sums_[node][i] + lent * about.mean[i]) / (own + lent);
        means.variance =
            (own * means.mean[kNextEventSpread] + lent * lent * about.variance) / ((own + lent) * (own + lent));
        const RegionModel::Node& n = tree_.nodes[node];
        if (!n.is_leaf()) {
            for (const std::uint32_t child : n.child)
                propagate(child, means);
            return;
        }
        NextEventEvidence& region = pooled_[n.child[1]];
        for (std::size_t i = 0; i < kNextEventSums; ++i)
            region[i] = own * means.mean[i];
        region[kNextEventSpread] = own * own * means.variance;
    }

    const RegionModel& tree_;
    std::span<const NextEventEvidence> evidence_;
    std::vector<NextEventEvidence> sums_;  ///< evidence per node
    std::vector<NextEventEvidence> pooled_;
};

}  // namespace

std::vector<NextEventEvidence> pool_next_event(const RegionModel& tree, std::span<const NextEventEvidence> evidence) {
    return Pooling(tree, evidence).take();
}

NextEventVerdict decide_next_event(std::span<const NextEventEvidence> evidence, double paths,
                                   const NextEventPrice& price, TreesLearn trees, std::span<std::uint8_t> codes) {
    constexpr int kRounds = 8;
    double known = 0;
    for (const NextEventEvidence& e : evidence)
        known += e[kNextEventAsked];
    if (!(price.rays > 0 && price.variance > 0 && paths > 0) || known < tuned("next_event.least_vertices")) return {};
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

void NextEventLearner::learn(const RegionModel& tree, const CellSums& sums, const RefineSettings& settings,
                             RefineReport& report, RegionModel& next) {
    const std::uint32_t regions = tree.leaf_count();
    if (!sums.shape().with_next_event || sums.shape().regions != regions || tree.next_event.size() != regions)
        throw RunError("the sums to decide next event by belong to another tree");
    evidence_.resize(regions);
    for (std::uint32_t r = 0; r < regions; ++r)
        add_halved(evidence_[r], sums.next_event(r));
    paths_ = kKeptEvidence * paths_ + settings.next_event.paths;
    std::vector<std::uint8_t> codes = tree.next_event;
    report.next_event = decide_next_event(pool_next_event(tree, evidence_), paths_, settings.next_event,
                                          settings.last_update ? TreesLearn::no_more : TreesLearn::on, codes);
    std::vector<NextEventEvidence> inherited;
    inherited.reserve(report.origins.size());
    next.next_event.clear();
    for (const RegionOrigin& origin : report.origins) {
        next.next_event.push_back(codes[origin.region]);
        inherited.push_back(evidence_[origin.region]);
        for (double& sum : inherited.back())
            sum = std::ldexp(sum, -origin.halvings);
    }
    evidence_ = std::move(inherited);
}

NextEventVerdict ImageNextEventLearner::learn(const NextEventSums& sums, const NextEventPrice& price,
                                              std::uint8_t& code) {
    add_halved(evidence_, sums);
    paths_ = kKeptEvidence * paths_ + price.paths;
    return decide_next_event({&evidence_, 1}, paths_, price, TreesLearn::nothing, {&code, 1});
}

}  // namespace treefarm
