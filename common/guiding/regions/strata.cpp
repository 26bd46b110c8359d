// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/regions/strata.h"

#include <algorithm>
#include <numeric>

#include "common/guiding/regions/light_probabilities.h"
#include "common/math/direction_map.h"

namespace treefarm {
namespace {

constexpr int kStratumShift = 2 * (kDirectionBits - kStrataDepth);

std::uint32_t add_nodes(RegionModel& model, int halvings, std::uint32_t& regions) {
    const auto index = static_cast<std::uint32_t>(model.nodes.size());
    model.nodes.emplace_back();
    if (halvings == 0) {
        model.nodes[index] = {{0, regions++}};
        return index;
    }
    const std::uint32_t low = add_nodes(model, halvings - 1, regions);
    const std::uint32_t high = add_nodes(model, halvings - 1, regions);
    model.nodes[index] = {{low, high}};
    return index;
}

}  // namespace

std::uint32_t begin_even_regions(RegionModel& model, const Box3& bounds, const FirstModel& settings) {
    set_cube(model, bounds);
    std::uint32_t regions = 0;
    add_nodes(model, settings.grid_halvings, regions);
    model.quantum_exponent.assign(regions, quantum_exponent_for(settings.radiance_scale));
    model.bsdf_fraction.assign(regions, settings.bsdf_fraction);
    if (settings.with_lights) model.light_probabilities.assign(regions, kNothingLearned);
    return regions;
}

void advance_even_regions(RegionModel& model, RefineReport& report) {
    ++model.pass;
    model.trained = true;
    report = {};
    report.spatial_depth = spatial_depth(model);
    report.directional_depth = kStrataDepth;
    report.mean_cells = kStrata;
    for (std::uint32_t r = 0; r < model.leaf_count(); ++r)
        report.origins.push_back({r, 0});
}

std::uint32_t read_even_regions(ByteReader& in, RegionModel& model) {
    const std::uint32_t regions = read_regions(in, model);
    if (model.quantum_exponent.size() != regions) throw FormatError("a grid's regions do not match its nodes");
    read_optional(in, model, regions);
    return regions;
}

ModelFigures even_figures(const RegionModel& model) {
    ModelFigures figures;
    figures.nodes = model.nodes.size();
    figures.regions = model.leaf_count();
    figures.cells = figures.regions * kStrata;
    figures.spatial_depth = spatial_depth(model);
    figures.directional_depth = kStrataDepth;
    return figures;
}

/// The rounding error, less than 2^-24, is added to the first stratum, where it does not matter.
void set_strata(std::span<const double> weight, double even_part, std::uint32_t* mass) {
    const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
    std::uint32_t left = kWholeMass;
    for (std::uint32_t s = 0; s < kStrata; ++s) {
        const double part = even_part / kStrata + (1.0 - even_part) * (weight[s] / total);
        mass[s] = std::min(left, static_cast<std::uint32_t>(part * kWholeMass));
        left -= mass[s];
    }
    mass[0] += left;
}

StrataSampler::Sample StrataSampler::sample(std::uint32_t region, const Draw& random) const {
    const SquareSample drawn = sample_square(region, random[1], random[2], random[3]);
    return {square_to_direction(drawn.at), drawn.code, drawn.pdf};
}

StrataSampler::SquareSample StrataSampler::sample_square(std::uint32_t region, std::uint32_t pick, std::uint32_t u0,
                                                         std::uint32_t u1) const {
    const std::uint32_t* const mass = &mass_[region * kStrata];
    std::uint32_t rest = pick >> (32 - kMassBits), stratum = 0;
    while (rest >= mass[stratum])
        rest -= mass[stratum++];
    // On a grid of 2^23 steps per axis, whose centres are exact floats, the point is in the stratum by construction.
    constexpr int kFineBits = 23 - kDirectionBits, kInStratum = 23 - kStrataDepth;
    const std::uint32_t x = (compact_bits(stratum) << kInStratum) + (u0 >> (32 - kInStratum));
    const std::uint32_t y = (compact_bits(stratum >> 1) << kInStratum) + (u1 >> (32 - kInStratum));
    const auto coordinate = [](std::uint32_t step) { return static_cast<float>(2 * step + 1) * 0x1p-24f; };
    const std::uint32_t code = spread_bits(x >> kFineBits) | (spread_bits(y >> kFineBits) << 1);
    return {{coordinate(x), coordinate(y)}, code, pdf(region, code)};
}

float StrataSampler::pdf(std::uint32_t region, std::uint32_t code) const {
    constexpr float kScale = kInvFourPi * static_cast<float>(kStrata) / static_cast<float>(kWholeMass);
    return kScale * static_cast<float>(mass_[cell(region, code)]);
}

std::uint32_t StrataSampler::cell(std::uint32_t region, std::uint32_t code) {
    return region * kStrata + (code >> kStratumShift);
}

std::uint32_t StrataSampler::cell_side(std::uint32_t, std::uint32_t) {
    return 1u << (kDirectionBits - kStrataDepth);
}

}  // namespace treefarm
