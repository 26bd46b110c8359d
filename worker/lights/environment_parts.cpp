// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/environment_parts.h"

#include <algorithm>
#include <cstddef>

namespace treefarm {

EnvironmentGrid::EnvironmentGrid(int width, int height)
    : width_(width),
      height_(height),
      columns_(std::min(width, kMostColumns)),
      rows_(std::min(height, kMostRows)),
      blocks_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

namespace {

/// Block of a texel along an axis divided into even blocks, and the first texel of a block.
int block_of(int texel, int texels, int blocks) {
    return static_cast<int>((static_cast<long long>(texel) * blocks + blocks - 1) / texels);
}
int begin_of(int block, int texels, int blocks) {
    return static_cast<int>(static_cast<long long>(block) * texels / blocks);
}

}  // namespace

void EnvironmentGrid::add(int x, int y, double weight, double solid_angle) {
    const int column = block_of(x, width_, columns_), row = block_of(y, height_, rows_);
    Sums& block =
        blocks_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
    block.weight += weight;
    block.solid_angle += solid_angle;
}

EnvironmentGrid::Cut EnvironmentGrid::best_cut(const EnvironmentPart& part) const {
    std::vector<Sums> columns(static_cast<std::size_t>(part.x1 - part.x0)),
        rows(static_cast<std::size_t>(part.y1 - part.y0));
    Sums whole;
    for (int y = part.y0; y < part.y1; ++y)
        for (int x = part.x0; x < part.x1; ++x) {
            const Sums& block =
                blocks_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x)];
            for (Sums* sums : {&columns[static_cast<std::size_t>(x - part.x0)],
                               &rows[static_cast<std::size_t>(y - part.y0)], &whole}) {
                sums->weight += block.weight;
                sums->solid_angle += block.solid_angle;
            }
        }
    Cut best;
    const auto try_cuts = [&](const std::vector<Sums>& lines, bool of_rows, int first) {
        Sums below;
        for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
            below.weight += lines[i].weight;
            below.solid_angle += lines[i].solid_angle;
            const Sums above{whole.weight - below.weight, whole.solid_angle - below.solid_angle};
            const double gain = whole.cost() - below.cost() - above.cost();
            if (gain > best.gain) best = {gain, of_rows, first + static_cast<int>(i) + 1};
        }
    };
    try_cuts(rows, true, part.y0);
    try_cuts(columns, false, part.x0);
    return best;
}

std::vector<EnvironmentPart> EnvironmentGrid::parts(int most) const {
    std::vector<EnvironmentPart> parts{{0, 0, columns_, rows_}};
    std::vector<Cut> cuts{best_cut(parts[0])};
    while (static_cast<int>(parts.size()) < most) {
        const auto best =
            std::max_element(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.gain < b.gain; });
        if (!(best->gain > 0)) break;
        const auto from = static_cast<std::size_t>(best - cuts.begin());
        EnvironmentPart above = parts[from];
        above.cut_from = static_cast<int>(from);
        above.cut_rows = best->rows;
        above.cut_at = best->at;
        (best->rows ? above.y0 : above.x0) = best->at;
        (best->rows ? parts[from].y1 : parts[from].x1) = best->at;
        cuts[from] = best_cut(parts[from]);
        cuts.push_back(best_cut(above));
        parts.push_back(above);
    }
    for (EnvironmentPart& part : parts) {  // from blocks to texels
        part.x0 = begin_of(part.x0, width_, columns_);
        part.x1 = begin_of(part.x1, width_, columns_);
        part.y0 = begin_of(part.y0, height_, rows_);
        part.y1 = begin_of(part.y1, height_, rows_);
        part.cut_at = part.cut_rows ? begin_of(part.cut_at, height_, rows_) : begin_of(part.cut_at, width_, columns_);
    }
    return parts;
}

}  // namespace treefarm
