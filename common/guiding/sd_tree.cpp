// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree.h"

#include <algorithm>
#include <cmath>

#include "common/plan/policy.h"

namespace treefarm {
namespace {

int exponent_of(float value) {
    int exponent = 0;
    std::frexp(value, &exponent);
    return exponent;
}

}  // namespace

SdTree initial_tree(const Box3& bounds, const InitialTree& settings) {
    SdTree tree;
    if (!bounds.isEmpty()) {
        tree.origin = bounds.min;
        const Vec3 size = bounds.max - bounds.min;
        tree.extent = std::max(size.x, std::max(size.y, size.z));
    }
    // A scene without extent (no shape, or a point) still needs a cube to look things up in.
    if (!(tree.extent > 0.0f)) tree.extent = 1.0f;
    tree.nodes.push_back({{0, 0}});
    const std::uint32_t cells = 1u << (2 * kPolicy.learning.initial_depth);
    tree.cell_begin = {0};
    for (int distribution = 0; distribution < (settings.with_views ? 2 : 1); ++distribution) {
        tree.cell_depth.insert(tree.cell_depth.end(), cells, kPolicy.learning.initial_depth);
        tree.cell_mass.insert(tree.cell_mass.end(), cells, 1u << (kMassBits - 2 * kPolicy.learning.initial_depth));
        tree.cell_begin.push_back(tree.cell_count());
        tree.quantum_exponent.push_back(quantum_exponent_for(settings.radiance_scale));
        tree.bsdf_fraction.push_back(settings.bsdf_fraction);
    }
    if (settings.with_views) {
        tree.view_set = {0};
        tree.view_begin = {0, 1};
        tree.view_depth = {0};
        tree.view_fraction = {settings.view_fraction};
        if (settings.view_fraction == 0.0f)
            tree.bsdf_fraction.back() = static_cast<float>(kPolicy.learning.least_bsdf_fraction);
    }
    if (settings.with_lights) tree.light_probabilities = {{kLightProbabilityOne}};
    return tree;
}

std::int16_t quantum_exponent_for(float mean_record) {
    if (!(mean_record > 0.0f) || !std::isfinite(mean_record)) mean_record = 1.0f;
    return static_cast<std::int16_t>(exponent_of(mean_record) - kMeanRecordBits);
}

}  // namespace treefarm
