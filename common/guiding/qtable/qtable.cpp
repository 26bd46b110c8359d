// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/qtable/qtable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/error.h"
#include "common/base/policy.h"

namespace treefarm {
namespace {

constexpr std::uint8_t kVersion = 1;

/// Probabilities of all strata, proportional to max(Q, floor).
std::vector<std::uint32_t> strata_of(const QTableModel& model) {
    std::vector<std::uint32_t> mass(model.q.size());
    std::array<double, kStrata> weight;
    for (std::size_t first = 0; first < model.q.size(); first += kStrata) {
        double mean = 0;
        for (std::size_t s = 0; s < kStrata; ++s)
            mean += double{model.q[first + s]} / kStrata;
        for (std::size_t s = 0; s < kStrata; ++s)
            weight[s] = mean > 0 ? std::max(double{model.q[first + s]}, kPolicy.grids.table_floor * mean) : 1.0;
        set_strata(weight, 0.0, &mass[first]);
    }
    return mass;
}

}  // namespace

QTableSampler::QTableSampler(const QTableModel& model) : RegionSampler(model), strata_(strata_of(model)), q_(model.q) {}

QTableModel QTableLearner::learn(const QTableModel& model, const CellSums& sums, const RefineSettings& settings,
                                 bool learn_mixture, RefineReport& report) {
    const std::size_t cells = model.q.size();
    if (sums.cells().size() != cells || sums.visits().size() != cells || sums.counts().size() != model.leaf_count())
        throw RunError("the sums to learn from belong to another table");
    QTableModel next = model;
    advance_even_regions(next, report);
    visits_.resize(cells);
    for (std::uint32_t r = 0; r < model.leaf_count(); ++r) {
        double recorded = 0;
        for (std::size_t c = r * std::size_t{kStrata}; c < (r + 1) * std::size_t{kStrata}; ++c) {
            const auto sum = static_cast<double>(sums.cells()[c]);
            const double before = kPolicy.learning.kept_evidence * visits_[c];
            recorded += sum;
            visits_[c] = before + static_cast<double>(sums.visits()[c]);
            if (visits_[c] == 0) continue;
            const double q = (double{model.q[c]} * before + std::ldexp(sum, model.quantum_exponent[r])) / visits_[c];
            next.q[c] = static_cast<float>(std::min(q, double{std::numeric_limits<float>::max()}));
        }
        next.quantum_exponent[r] = learned_exponent(recorded, sums.counts()[r], model.quantum_exponent[r]);
    }
    if (model.learns_lights()) lights_.learn(model, sums, report.origins, next);
    if (model.decides_next_event()) next_event_.learn(model, sums, settings, report, next);
    if (learn_mixture) mixture_.learn(model, sums, report.origins, next);
    return next;
}

QTableModel QTableGuide::first(const Box3& bounds, const FirstModel& settings) {
    QTableModel model;
    const std::uint32_t regions = begin_even_regions(model, bounds, settings);
    model.q.assign(std::size_t{regions} * kStrata, 0.0f);
    return model;
}

Bytes QTableGuide::encode(const QTableModel& model) {
    ByteWriter out;
    write_regions(out, model);
    write_optional(out, model);
    out.put_array(std::span<const float>(model.q));
    return pack_model(kMagic, kVersion, out.take());
}

QTableModel QTableGuide::decode(std::span<const std::uint8_t> bytes) {
    const Bytes raw = unpack_model(kMagic, kVersion, bytes);
    ByteReader in(raw);
    QTableModel model;
    const std::uint32_t regions = read_even_regions(in, model);
    model.q = in.get_array<float>();
    if (model.q.size() != std::size_t{regions} * kStrata)
        throw FormatError("a table's strata do not match its regions");
    for (const float q : model.q)
        if (!(q >= 0.0f && std::isfinite(q))) throw FormatError("a radiance of a table is out of range");
    in.expect_end();
    return model;
}

}  // namespace treefarm
