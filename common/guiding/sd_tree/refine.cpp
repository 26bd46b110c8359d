// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree/refine.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include "common/base/parallel.h"
#include "common/guiding/sd_tree/refine_directions.h"
#include "common/guiding/sd_tree/refine_views.h"

namespace treefarm {
namespace {

/// Limit of cells beyond which regions no longer split, so that indices stay below 2^32.
constexpr std::uint64_t kMaxCells = std::uint64_t{1} << 31;
/// Least number of regions per thread.
constexpr std::size_t kLeastPart = 64;

/// Divisor of a distribution: its gain from finer cells depends on how often it is sampled.
std::uint32_t cell_divisor(const SdTree& tree, std::uint32_t distribution, const RefineSettings& settings) {
    if (distribution >= tree.region_count()) return settings.directional_divisor;
    const double tree_fraction = 1.0 - static_cast<double>(tree.bsdf_fraction[distribution]);
    const double use = std::clamp(2.0 * tree_fraction, settings.least_use, 1.0);
    return static_cast<std::uint32_t>(std::lround(use * settings.directional_divisor));
}

class TreeRefiner {
  public:
    TreeRefiner(const SdTree& tree, const CellSums& sums, const RefineSettings& settings, RefineReport& report)
        : old_(tree), sums_(sums), settings_(settings), report_(report) {}

    SdTree run() {
        refine_regions();
        result_.pass = old_.pass + 1;
        result_.trained = true;
        result_.origin = old_.origin;
        result_.extent = old_.extent;
        result_.cell_begin.push_back(0);
        copy(0, 0);
        report_.mean_cells = static_cast<double>(result_.cell_count()) / result_.region_count();
        return std::move(result_);
    }

  private:
    void refine_regions() {
        refined_.resize(old_.region_count());
        std::mutex reporting;
        in_parts(refined_.size(), kLeastPart, [&](std::size_t begin, std::size_t end) {
            RefineReport report;
            for (std::size_t r = begin; r < end; ++r)
                refined_[r] = refine_distribution(old_, sums_, static_cast<std::uint32_t>(r), settings_, report);
            const std::scoped_lock lock(reporting);
            report_.directional_depth_capped += report.directional_depth_capped;
            report_.directional_depth = std::max(report_.directional_depth, report.directional_depth);
        });
    }

    std::uint32_t copy(std::uint32_t old_node, int depth) {
        const SdTree::Node& node = old_.nodes[old_node];
        if (node.is_leaf()) {
            old_region_ = node.child[1];
            leaf_depth_ = depth;
            return split(refined_[old_region_], region_weight(), depth);
        }
        const auto index = add_node();
        const std::uint32_t low = copy(node.child[0], depth + 1);
        const std::uint32_t high = copy(node.child[1], depth + 1);
        result_.nodes[index] = {{low, high}};
        return index;
    }

    /// Weighted records of the region, halved with each split.
    double region_weight() const {
        std::uint64_t count = sums_.counts()[old_region_];
        // In the published method every region has its own T2.
        if (settings_.views_record_alone && old_.view_count() != 0 && old_.view_set[old_region_] != SdTree::kNoViews) {
            const std::uint32_t set = old_.view_set[old_region_];
            for (std::uint32_t v = old_.view_begin[set]; v < old_.view_begin[set + 1]; ++v)
                count += sums_.counts()[old_.region_count() + v];
        }
        return static_cast<double>(count) * settings_.record_weight;
    }

    std::uint32_t split(const RefinedDistribution& region, double weight, int depth) {
        const auto index = add_node();
        if (weight > settings_.spatial_threshold) {
            const bool has_free_cells = result_.cell_depth.size() + region.directions.depth.size() < kMaxCells;
            if (depth < kMaxSpatialDepth && has_free_cells) {
                const std::uint32_t low = split(region, weight / 2, depth + 1);
                const std::uint32_t high = split(region, weight / 2, depth + 1);
                result_.nodes[index] = {{low, high}};
                return index;
            }
            ++(has_free_cells ? report_.spatial_depth_capped : report_.memory_capped);
        }
        report_.spatial_depth = std::max(report_.spatial_depth, depth);
        result_.nodes[index] = {{0, result_.region_count()}};
        add_distribution(result_, region, old_.bsdf_fraction[old_region_]);
        if (settings_.with_flux) result_.flux.push_back(region.flux);
        report_.origins.push_back({old_region_, depth - leaf_depth_});
        return index;
    }

    std::uint32_t add_node() {
        result_.nodes.emplace_back();
        return static_cast<std::uint32_t>(result_.nodes.size() - 1);
    }

    const SdTree& old_;
    const CellSums& sums_;
    const RefineSettings& settings_;
    RefineReport& report_;
    std::vector<RefinedDistribution> refined_;  ///< per region of the old tree
    SdTree result_;
    std::uint32_t old_region_ = 0;  ///< region being refined
    int leaf_depth_ = 0;            ///< depth of this region
};

}  // namespace

RefinedDistribution refine_distribution(const SdTree& tree, const CellSums& sums, std::uint32_t distribution,
                                        const RefineSettings& settings, RefineReport& report) {
    const std::uint32_t begin = tree.cell_begin[distribution], count = tree.cell_begin[distribution + 1] - begin;
    const std::span<const std::uint8_t> depths(&tree.cell_depth[begin], count);
    std::span<const std::uint64_t> energies(&sums.cells()[begin], count);
    const double total = std::accumulate(energies.begin(), energies.end(), 0.0,
                                         [](double sum, std::uint64_t e) { return sum + static_cast<double>(e); });
    std::vector<std::uint64_t> deviations;
    if (settings.target == GuidingTarget::variance) {
        for (std::uint32_t c = 0; c < count; ++c)
            deviations.push_back(deviation(energies[c], depths[c]));
        energies = deviations;
    }
    const std::uint32_t divisor = cell_divisor(tree, distribution, settings);
    RefinedDistribution refined{refine_directions(depths, energies, divisor), tree.quantum_exponent[distribution]};
    report.directional_depth_capped += refined.directions.depth_capped;
    report.directional_depth = std::max(report.directional_depth, refined.directions.max_depth);
    if (settings.with_flux && distribution < tree.region_count()) {
        const float before = tree.flux.empty() ? 0.0f : tree.flux[distribution];
        refined.flux = learned_flux(total, sums.counts()[distribution], refined.quantum_exponent, before);
    }
    refined.quantum_exponent = learned_exponent(total, sums.counts()[distribution], refined.quantum_exponent);
    return refined;
}

void add_distribution(SdTree& tree, const RefinedDistribution& distribution, float bsdf_fraction) {
    const RefinedDirections& d = distribution.directions;
    tree.cell_depth.insert(tree.cell_depth.end(), d.depth.begin(), d.depth.end());
    tree.cell_mass.insert(tree.cell_mass.end(), d.mass.begin(), d.mass.end());
    tree.cell_begin.push_back(tree.cell_count());
    tree.quantum_exponent.push_back(distribution.quantum_exponent);
    tree.bsdf_fraction.push_back(bsdf_fraction);
}

SdTree refine(const SdTree& tree, const CellSums& sums, const RefineSettings& settings, RefineReport& report,
              std::span<const ViewAdvice> advice) {
    if (sums.cells().size() != tree.cell_count() || sums.counts().size() != tree.distribution_count() ||
        (!advice.empty() && advice.size() != tree.view_count()))
        throw RunError("the sums to refine by belong to another tree");
    report = {};
    SdTree refined = TreeRefiner(tree, sums, settings, report).run();
    if (tree.view_count() != 0) refine_views(tree, sums, settings, advice, refined, report);
    return refined;
}

}  // namespace treefarm
