// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree/tree_statistics.h"

#include <algorithm>
#include <cmath>

#include "common/math/direction_map.h"

namespace treefarm {
namespace {

/// Number, depths and spread of the cells of some distributions.
struct Cells {
    std::uint64_t count = 0;
    DepthCounts depth;
    Quantiles spread;
};

Cells cells_of(const SdTree& tree, std::uint32_t first, std::uint32_t last) {
    Cells cells;
    std::vector<double> counts;
    for (std::uint32_t d = first; d < last; ++d)
        counts.push_back(tree.cell_begin[d + 1] - tree.cell_begin[d]);
    cells.count = tree.cell_begin[last] - tree.cell_begin[first];
    for (std::uint32_t c = tree.cell_begin[first]; c < tree.cell_begin[last]; ++c)
        count_depth(cells.depth, tree.cell_depth[c]);
    cells.spread = quantiles_of(std::move(counts));
    return cells;
}

MixtureQuantiles mixtures_of(const SdTree& tree, std::uint32_t first, std::uint32_t last) {
    std::vector<double> bsdf, t1, t2;
    for (std::uint32_t d = first; d < last; ++d) {
        const auto a = static_cast<double>(tree.bsdf_fraction[d]);
        const double view =
            d < tree.region_count() ? 0.0 : static_cast<double>(tree.view_fraction[d - tree.region_count()]);
        bsdf.push_back(a);
        t2.push_back(view);
        t1.push_back(std::max(0.0, 1.0 - a - view));
    }
    return {quantiles_of(std::move(bsdf)), quantiles_of(std::move(t1)), quantiles_of(std::move(t2))};
}

}  // namespace

TreeStatistics tree_statistics(const SdTree& tree) {
    const std::uint32_t regions = tree.region_count(), all = tree.distribution_count();
    TreeStatistics s = region_statistics(tree);
    s.t2s = tree.view_set_count();
    s.views = tree.view_count();
    s.regions_with_t2 = static_cast<std::uint32_t>(
        std::count_if(tree.view_set.begin(), tree.view_set.end(), [](auto set) { return set != SdTree::kNoViews; }));
    for (const std::uint8_t depth : tree.view_depth)
        count_depth(s.view_depth, depth);
    Cells of_regions = cells_of(tree, 0, regions), of_views = cells_of(tree, regions, all);
    s.region_cells = of_regions.count;
    s.view_cells = of_views.count;
    s.region_cell_depth = std::move(of_regions.depth);
    s.view_cell_depth = std::move(of_views.depth);
    s.cells_per_region = of_regions.spread;
    s.cells_per_view = of_views.spread;
    std::vector<double> views;
    for (std::uint32_t t = 0; t < s.t2s; ++t)
        views.push_back(tree.view_begin[t + 1] - tree.view_begin[t]);
    s.views_per_t2 = quantiles_of(std::move(views));
    s.regions_mixture = mixtures_of(tree, 0, regions);
    s.views_mixture = mixtures_of(tree, regions, all);
    return s;
}

std::vector<double> cells_by_region(const SdTree& tree) {
    const std::uint32_t regions = tree.region_count();
    std::vector<double> sharers(tree.view_set_count(), 0.0), cells(regions);
    for (const std::uint32_t set : tree.view_set)
        if (set != SdTree::kNoViews) sharers[set] += 1;
    for (std::uint32_t r = 0; r < regions; ++r) {
        cells[r] = tree.cell_begin[r + 1] - tree.cell_begin[r];
        if (tree.view_set.empty() || tree.view_set[r] == SdTree::kNoViews) continue;
        const std::uint32_t set = tree.view_set[r];
        const std::uint32_t first = tree.cell_begin[regions + tree.view_begin[set]];
        const std::uint32_t last = tree.cell_begin[regions + tree.view_begin[set + 1]];
        cells[r] += (last - first) / sharers[set];
    }
    return cells;
}

std::vector<float> density_map(const SdTree& tree, std::uint32_t distribution, int bits) {
    const std::size_t side = std::size_t{1} << bits, squares = side * side;
    const std::uint64_t square = std::uint64_t{1} << (2 * (kDirectionBits - bits));  // codes of one square
    std::vector<double> mass(squares, 0.0);
    std::uint64_t code = 0;
    for (std::uint32_t c = tree.cell_begin[distribution]; c < tree.cell_begin[distribution + 1]; ++c) {
        const std::uint64_t size = std::uint64_t{1} << (2 * (kDirectionBits - tree.cell_depth[c]));
        const std::uint64_t first = code / square, count = std::max<std::uint64_t>(size / square, 1);
        for (std::uint64_t s = first; s < first + count; ++s)
            mass[s] += static_cast<double>(tree.cell_mass[c]) / static_cast<double>(count);
        code += size;
    }
    std::vector<float> density(squares);
    const double scale = static_cast<double>(squares) / (std::ldexp(4.0, kMassBits) * 3.14159265358979323846);
    for (std::uint32_t s = 0; s < squares; ++s)
        density[compact_bits(s >> 1) * side + compact_bits(s)] = static_cast<float>(mass[s] * scale);
    return density;
}

}  // namespace treefarm
