// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/grid/grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/base/error.h"
#include "common/base/policy.h"
#include "common/math/elementary.h"

namespace treefarm {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::uint32_t kOne = 1u << kMassBits;

}  // namespace

GridSampler::GridSampler(const GridModel& model) : RegionSampler(model), strata_(model.mass) {}

float GridSampler::radiance(std::uint32_t region, std::uint32_t code) const {
    if (!(flux(region) > 0.0f)) return -1.0f;
    const auto even = static_cast<float>(kPolicy.grids.even_part);
    return flux(region) * std::max(pdf(region, code) - even * kInvFourPi, 0.0f) / (1.0f - even);
}

GridModel GridLearner::learn(const GridModel& model, const CellSums& sums, const RefineSettings& settings,
                             bool learn_mixture, RefineReport& report) {
    if (sums.cells().size() != model.mass.size() || sums.counts().size() != model.leaf_count())
        throw RunError("the sums to learn from belong to another grid");
    GridModel next = model;
    advance_even_regions(next, report);
    next.flux.resize(settings.with_flux ? model.leaf_count() : 0);
    for (std::uint32_t r = 0; r < model.leaf_count(); ++r) {
        std::array<double, kStrata> energy;
        for (std::uint32_t s = 0; s < kStrata; ++s)
            energy[s] = static_cast<double>(sums.cells()[r * kStrata + s]);
        const double recorded = std::accumulate(energy.begin(), energy.end(), 0.0);
        if (settings.with_flux)
            next.flux[r] = learned_flux(recorded, sums.counts()[r], model.quantum_exponent[r], next.flux[r]);
        next.quantum_exponent[r] = learned_exponent(recorded, sums.counts()[r], model.quantum_exponent[r]);
        // Variance is least if probabilities are proportional to the root of the second moment.
        if (settings.target == GuidingTarget::variance)
            for (double& e : energy)
                e = std::sqrt(e);
        if (recorded > 0) set_strata(energy, kPolicy.grids.even_part, &next.mass[r * kStrata]);
    }
    if (model.learns_lights()) lights_.learn(model, sums, report.origins, next);
    if (model.decides_next_event()) next_event_.learn(model, sums, settings, report, next);
    if (learn_mixture) mixture_.learn(model, sums, report.origins, next);
    return next;
}

GridModel GridGuide::first(const Box3& bounds, const FirstModel& settings) {
    GridModel model;
    const std::uint32_t regions = begin_even_regions(model, bounds, settings);
    model.mass.assign(std::size_t{regions} * kStrata, kOne / kStrata);
    return model;
}

Bytes GridGuide::encode(const GridModel& model) {
    ByteWriter out;
    write_regions(out, model);
    write_optional(out, model);
    for (const std::uint32_t mass : model.mass)
        out.put_varint(mass);
    return pack_model(kMagic, kVersion, out.take());
}

GridModel GridGuide::decode(std::span<const std::uint8_t> bytes) {
    const Bytes raw = unpack_model(kMagic, kVersion, bytes);
    ByteReader in(raw);
    GridModel model;
    const std::uint32_t regions = read_even_regions(in, model);
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

}  // namespace treefarm
