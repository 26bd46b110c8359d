// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree/sd_tree_guide.h"

#include <algorithm>

namespace treefarm {

ModelFigures SdTreeGuide::figures(const SdTree& tree) {
    ModelFigures figures;
    figures.nodes = tree.nodes.size();
    figures.regions = tree.region_count();
    figures.views = tree.view_count();
    figures.cells = tree.cell_count();
    figures.spatial_depth = spatial_depth(tree);
    figures.directional_depth =
        tree.cell_depth.empty() ? 0 : *std::max_element(tree.cell_depth.begin(), tree.cell_depth.end());
    return figures;
}

}  // namespace treefarm
