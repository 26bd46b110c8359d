// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/regions/model_statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace treefarm {
namespace {

DepthCounts region_depths(const RegionModel& model) {
    DepthCounts counts;
    struct At {
        std::uint32_t node;
        std::size_t depth;
    };
    std::vector<At> stack{{0, 0}};
    while (!stack.empty()) {
        const At at = stack.back();
        stack.pop_back();
        const RegionModel::Node& node = model.nodes[at.node];
        if (node.is_leaf()) {
            count_depth(counts, at.depth);
            continue;
        }
        stack.push_back({node.child[1], at.depth + 1});
        stack.push_back({node.child[0], at.depth + 1});
    }
    return counts;
}

}  // namespace

void count_depth(DepthCounts& counts, std::size_t depth) {
    if (counts.size() <= depth) counts.resize(depth + 1, 0);
    ++counts[depth];
}

Quantiles quantiles_of(std::vector<double> values) {
    Quantiles spread;
    spread.count = values.size();
    if (values.empty()) return spread;
    std::sort(values.begin(), values.end());
    double sum = 0;
    for (const double value : values)
        sum += value;
    const auto quantile = [&](double fraction) {
        const double rank = std::ceil(fraction * static_cast<double>(values.size()));
        return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
    };
    spread.mean = sum / static_cast<double>(values.size());
    spread.least = values.front();
    spread.tenth = quantile(0.1);
    spread.median = quantile(0.5);
    spread.nine_tenths = quantile(0.9);
    spread.most = values.back();
    return spread;
}

TreeStatistics region_statistics(const RegionModel& model) {
    TreeStatistics s;
    s.pass = model.pass;
    s.trained = model.trained;
    s.nodes = static_cast<std::uint32_t>(model.nodes.size());
    s.regions = model.leaf_count();
    s.region_depth = region_depths(model);
    return s;
}

TreeStatistics even_statistics(const RegionModel& model, const ModelFigures& size) {
    TreeStatistics s = region_statistics(model);
    s.region_cells = size.cells;
    s.region_cell_depth.assign(static_cast<std::size_t>(size.directional_depth) + 1, 0);
    s.region_cell_depth.back() = static_cast<std::uint32_t>(size.cells);
    s.cells_per_region = quantiles_of(std::vector<double>(s.regions, double(size.cells) / s.regions));
    std::vector<double> bsdf, guide;
    for (const float a : model.bsdf_fraction) {
        bsdf.push_back(static_cast<double>(a));
        guide.push_back(1.0 - static_cast<double>(a));
    }
    s.regions_mixture = {quantiles_of(std::move(bsdf)), quantiles_of(std::move(guide)),
                         quantiles_of(std::vector<double>(s.regions, 0.0))};
    return s;
}

}  // namespace treefarm
