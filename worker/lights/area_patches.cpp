// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/area_patches.h"

#include <algorithm>

namespace treefarm {
namespace {

/// A range of triangles, with its area.
struct Run {
    std::uint32_t begin, end;
    double area;
};

}  // namespace

AreaPatches::AreaPatches(std::span<const double> areas, const std::function<Vec3(std::uint32_t)>& center) {
    double total = 0;
    for (std::uint32_t i = 0; i < areas.size(); ++i) {
        if (!(areas[i] > 0)) continue;
        triangles_.push_back(i);
        total += areas[i];
    }
    if (triangles_.size() <= kFewTriangles) {
        triangles_.clear();
        return;
    }
    std::vector<Vec3> centers(areas.size(), Vec3(0.0f));
    for (const std::uint32_t i : triangles_)
        centers[i] = center(i);
    std::vector<Run> runs{{0, static_cast<std::uint32_t>(triangles_.size()), total}};
    const auto cuts = [&](const Run& run) {
        return run.end - run.begin > kFewTriangles && run.area > kSmallShare * total;
    };
    while (runs.size() < kMostPatches) {
        const auto largest = std::max_element(runs.begin(), runs.end(), [&](const Run& a, const Run& b) {
            return (cuts(a) ? a.area : -1.0) < (cuts(b) ? b.area : -1.0);
        });
        if (!cuts(*largest)) break;
        Box3 box;
        for (std::uint32_t i = largest->begin; i < largest->end; ++i)
            box.extendBy(centers[triangles_[i]]);
        const unsigned axis = box.majorAxis();
        const auto first = triangles_.begin() + largest->begin, last = triangles_.begin() + largest->end;
        std::sort(first, last, [&](std::uint32_t a, std::uint32_t b) {
            const float at_a = centers[a][static_cast<int>(axis)], at_b = centers[b][static_cast<int>(axis)];
            return at_a != at_b ? at_a < at_b : a < b;
        });
        // Cuts at half the area, with at least one triangle on each side.
        double below = 0;
        std::uint32_t middle = largest->begin;
        do
            below += areas[triangles_[middle++]];
        while (middle + 1 < largest->end && below < 0.5 * largest->area);
        const Run above{middle, largest->end, largest->area - below};
        *largest = {largest->begin, middle, below};
        runs.push_back(above);
    }
    std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.begin < b.begin; });
    density_.resize(areas.size(), 0.0f);
    patch_of_.resize(areas.size(), 0);
    for (const Run& run : runs) {
        begin_.push_back(run.begin);
        std::vector<double> weights;
        for (std::uint32_t i = run.begin; i < run.end; ++i)
            weights.push_back(areas[triangles_[i]]);
        const DiscreteTable& table = tables_.emplace_back(weights);
        double sum = 0;
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const std::uint32_t triangle = triangles_[i];
            density_[triangle] = static_cast<float>(double(table.probability(i - run.begin)) / areas[triangle]);
            patch_of_[triangle] = static_cast<std::uint16_t>(tables_.size() - 1);
            sum += areas[triangle];
        }
        share_.push_back(sum / total);
    }
    begin_.push_back(static_cast<std::uint32_t>(triangles_.size()));
}

}  // namespace treefarm
