// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/regions/next_event.h"

#include <cmath>
#include <utility>

#include "common/decide/next_event/next_event_constants.h"

namespace treefarm {
namespace {

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
        const double lent = tuned<policy::kNextEvent>("next_event.lent_vertices");
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

}  // namespace treefarm
