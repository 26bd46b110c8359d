// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/grid/grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/math/elementary.h"

namespace treefarm {
namespace {

constexpr double kEvenPart = 0.1;  ///< of the samples: light that no record has found must be found

}  // namespace

float GridSampler::radiance(std::uint32_t region, std::uint32_t code) const {
    if (!(flux(region) > 0.0f)) return -1.0f;
    const auto even = static_cast<float>(kEvenPart);
    return flux(region) * std::max(pdf(region, code) - even * kInvFourPi, 0.0f) / (1.0f - even);
}

void GridCells::begin(GridModel& model, std::size_t cells) {
    model.mass.assign(cells, kWholeMass / kStrata);
}

double GridCells::learn(const GridModel& model, const CellSums& sums, const RefineSettings& settings,
                        std::uint32_t region, GridModel& next) {
    std::array<double, kStrata> energy;
    for (std::uint32_t s = 0; s < kStrata; ++s)
        energy[s] = static_cast<double>(sums.cells()[region * kStrata + s]);
    const double recorded = std::accumulate(energy.begin(), energy.end(), 0.0);
    next.flux.resize(settings.with_flux ? model.leaf_count() : 0);
    if (settings.with_flux)
        next.flux[region] =
            learned_flux(recorded, sums.counts()[region], model.quantum_exponent[region], next.flux[region]);
    // Variance is least if probabilities are proportional to the root of the second moment.
    if (settings.target == GuidingTarget::variance)
        for (double& e : energy)
            e = std::sqrt(e);
    if (recorded > 0) set_strata(energy, kEvenPart, &next.mass[region * kStrata]);
    return recorded;
}

void GridCells::write(ByteWriter& out, const GridModel& model) {
    for (const std::uint32_t mass : model.mass)
        out.put_varint(mass);
}

void GridCells::read(ByteReader& in, std::uint32_t regions, GridModel& model) {
    if (std::size_t{regions} * kStrata > in.remaining()) throw FormatError("a grid's strata are cut short");
    for (std::uint32_t r = 0; r < regions; ++r) {
        std::uint64_t left = kWholeMass;
        for (std::uint32_t s = 0; s < kStrata; ++s) {
            const std::uint64_t mass = in.get_varint();
            if (mass > left) throw FormatError("a region's probabilities sum to more than one");
            model.mass.push_back(static_cast<std::uint32_t>(mass));
            left -= mass;
        }
        if (left != 0) throw FormatError("a region's probabilities do not sum to one");
    }
}

}  // namespace treefarm
