// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/grid/grid.h"

#include <cmath>
#include <numeric>

#include "common/base/error.h"
#include "common/math/direction_map.h"

namespace treefarm {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::uint32_t kOne = 1u << kMassBits;
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

/// Probabilities in proportion to `energy`, which has a sum above 0, but for the even part. What rounding leaves goes
/// to the first stratum, which is none of importance: it is less than 2^-24.
void set_mass(std::span<const double> energy, double total, std::uint32_t* mass) {
    std::uint32_t left = kOne;
    for (std::uint32_t s = 0; s < kStrata; ++s) {
        const double part = kEvenPart / kStrata + (1.0 - kEvenPart) * (energy[s] / total);
        mass[s] = std::min(left, static_cast<std::uint32_t>(part * kOne));
        left -= mass[s];
    }
    mass[0] += left;
}

}  // namespace

GridSampler::GridSampler(const GridModel& model) : RegionSampler(model), mass_(model.mass) {}

GridSampler::Sample GridSampler::sample(std::uint32_t region, const Draw& random) const {
    const std::uint32_t* const mass = &mass_[region * kStrata];
    std::uint32_t rest = random[1] >> (32 - kMassBits), stratum = 0;
    while (rest >= mass[stratum])
        rest -= mass[stratum++];
    // On a grid of 2^23 steps an axis, whose centres are exact floats: the point lies in the stratum by construction.
    constexpr int kFineBits = 23 - kDirectionBits, kInStratum = 23 - kStrataDepth;
    const std::uint32_t x = (compact_bits(stratum) << kInStratum) + (random[2] >> (32 - kInStratum));
    const std::uint32_t y = (compact_bits(stratum >> 1) << kInStratum) + (random[3] >> (32 - kInStratum));
    const auto coordinate = [](std::uint32_t step) { return static_cast<float>(2 * step + 1) * 0x1p-24f; };
    const std::uint32_t code = spread_bits(x >> kFineBits) | (spread_bits(y >> kFineBits) << 1);
    return {square_to_direction({coordinate(x), coordinate(y)}), code, pdf(region, code)};
}

float GridSampler::pdf(std::uint32_t region, std::uint32_t code) const {
    constexpr float kScale = kInvFourPi * static_cast<float>(kStrata) / static_cast<float>(kOne);
    return kScale * static_cast<float>(mass_[cell(region, code)]);
}

std::uint32_t GridSampler::cell(std::uint32_t region, std::uint32_t code) const {
    return region * kStrata + (code >> kStratumShift);
}

std::uint32_t GridSampler::cell_side(std::uint32_t, std::uint32_t) const {
    return 1u << (kDirectionBits - kStrataDepth);
}

GridModel GridLearner::learn(const GridModel& model, const CellSums& sums, const RefineSettings& settings,
                             bool learn_mixture, RefineReport& report) {
    if (sums.cells().size() != model.mass.size() || sums.counts().size() != model.leaf_count())
        throw RunError("the sums to learn from belong to another grid");
    GridModel next = model;
    next.pass = model.pass + 1;
    next.trained = true;
    report = {};
    report.spatial_depth = spatial_depth(model);
    report.directional_depth = kStrataDepth;
    report.mean_cells = kStrata;
    for (std::uint32_t r = 0; r < model.leaf_count(); ++r) {
        report.origins.push_back({r, 0});
        std::array<double, kStrata> energy;
        for (std::uint32_t s = 0; s < kStrata; ++s)
            energy[s] = static_cast<double>(sums.cells()[r * kStrata + s]);
        const double recorded = std::accumulate(energy.begin(), energy.end(), 0.0);
        next.quantum_exponent[r] = learned_exponent(recorded, sums.counts()[r], model.quantum_exponent[r]);
        // Least variance has probabilities in proportion to the root of the second moment.
        if (settings.target == GuidingTarget::variance)
            for (double& e : energy)
                e = std::sqrt(e);
        const double total = std::accumulate(energy.begin(), energy.end(), 0.0);
        if (total > 0) set_mass(energy, total, &next.mass[r * kStrata]);
    }
    if (model.learns_lights()) lights_.learn(model, sums, report.origins, next);
    if (learn_mixture) mixture_.learn(model, sums, report.origins, next);
    return next;
}

GridModel GridGuide::first(const Box3& bounds, const FirstModel& settings) {
    GridModel model;
    set_cube(model, bounds);
    std::uint32_t regions = 0;
    add_nodes(model, settings.grid_halvings, regions);
    model.quantum_exponent.assign(regions, quantum_exponent_for(settings.radiance_scale));
    model.bsdf_fraction.assign(regions, settings.bsdf_fraction);
    if (settings.with_lights) model.light_probabilities.assign(regions, kChoiceByPower);
    model.mass.assign(std::size_t{regions} * kStrata, kOne / kStrata);
    return model;
}

Bytes GridGuide::encode(const GridModel& model) {
    ByteWriter out;
    write_regions(out, model);
    write_lights(out, model);
    for (const std::uint32_t mass : model.mass)
        out.put_varint(mass);
    return pack_model(kMagic, kVersion, out.take());
}

GridModel GridGuide::decode(std::span<const std::uint8_t> bytes) {
    const Bytes raw = unpack_model(kMagic, kVersion, bytes);
    ByteReader in(raw);
    GridModel model;
    const std::uint32_t regions = read_regions(in, model);
    if (model.quantum_exponent.size() != regions) throw FormatError("a grid's regions do not match its nodes");
    read_lights(in, model, regions);
    if (std::size_t{regions} * kStrata > in.remaining()) throw FormatError("a grid's strata are cut short");
    for (std::uint32_t r = 0; r < regions; ++r) {
        std::uint64_t left = kOne;
        for (std::uint32_t s = 0; s < kStrata; ++s) {
            const std::uint64_t mass = in.get_varint();
            if (mass > left) throw FormatError("a region's probabilities sum to more than one");
            model.mass.push_back(static_cast<std::uint32_t>(mass));
            left -= mass;
        }
        if (left != 0) throw FormatError("a region's probabilities do not sum to one");
    }
    in.expect_end();
    return model;
}

ModelFigures GridGuide::figures(const GridModel& model) {
    ModelFigures figures;
    figures.nodes = model.nodes.size();
    figures.regions = model.leaf_count();
    figures.cells = model.mass.size();
    figures.spatial_depth = spatial_depth(model);
    figures.directional_depth = kStrataDepth;
    return figures;
}

}  // namespace treefarm
