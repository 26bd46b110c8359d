// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/regions/region_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/guiding/regions/first_model.h"

namespace treefarm {
namespace {

int exponent_of(float value) {
    int exponent = 0;
    std::frexp(value, &exponent);
    return exponent;
}

/// Mean of `records` records, above 0, whose sum is `total` in units of 2^`exponent`.
float mean_record(double total, std::uint64_t records, std::int16_t exponent) {
    const double mean = std::ldexp(total / static_cast<double>(records), exponent);
    return static_cast<float>(std::min(mean, double{std::numeric_limits<float>::max()}));
}

}  // namespace

void set_cube(RegionModel& model, const Box3& bounds) {
    if (!bounds.isEmpty()) {
        model.origin = bounds.min;
        const Vec3 size = bounds.max - bounds.min;
        model.extent = std::max(size.x, std::max(size.y, size.z));
    }
    // A scene without extent (no shape, or a point) needs a cube, too.
    if (!(model.extent > 0.0f)) model.extent = 1.0f;
}

std::int16_t quantum_exponent_for(float mean_record) {
    if (!(mean_record > 0.0f) || !std::isfinite(mean_record)) mean_record = 1.0f;
    return static_cast<std::int16_t>(exponent_of(mean_record) - kMeanRecordBits);
}

std::int16_t learned_exponent(double total, std::uint64_t records, std::int16_t exponent) {
    if (!(total > 0 && records > 0)) return exponent;
    return quantum_exponent_for(mean_record(total, records, exponent));
}

float learned_flux(double total, std::uint64_t records, std::int16_t exponent, float before) {
    return records > 0 ? mean_record(total, records, exponent) : before;
}

int spatial_depth(const RegionModel& model) {
    int deepest = 0;
    std::vector<std::pair<std::uint32_t, int>> open = {{0, 0}};
    while (!open.empty()) {
        const auto [node, depth] = open.back();
        open.pop_back();
        deepest = std::max(deepest, depth);
        if (model.nodes[node].is_leaf()) continue;
        for (const std::uint32_t child : model.nodes[node].child)
            open.emplace_back(child, depth + 1);
    }
    return deepest;
}

}  // namespace treefarm
