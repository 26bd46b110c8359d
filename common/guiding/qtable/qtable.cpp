// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/qtable/qtable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/error.h"

namespace treefarm {
namespace {

/// Probabilities of all strata, proportional to max(Q, floor).
std::vector<std::uint32_t> strata_of(const QTableModel& model) {
    std::vector<std::uint32_t> mass(model.q.size());
    std::array<double, kStrata> weight;
    for (std::size_t first = 0; first < model.q.size(); first += kStrata) {
        double mean = 0;
        for (std::size_t s = 0; s < kStrata; ++s)
            mean += double{model.q[first + s]} / kStrata;
        for (std::size_t s = 0; s < kStrata; ++s)
            weight[s] = mean > 0 ? std::max(double{model.q[first + s]}, kTableFloor * mean) : 1.0;
        set_strata(weight, 0.0, &mass[first]);
    }
    return mass;
}

}  // namespace

QTableSampler::QTableSampler(const QTableModel& model) : StrataSampler(model, strata_of(model)), q_(model.q) {}

void QTableCells::begin(QTableModel& model, std::size_t cells) {
    model.q.assign(cells, 0.0f);
}

double QTableCells::learn(const QTableModel& model, const CellSums& sums, const RefineSettings&, std::uint32_t region,
                          QTableModel& next) {
    if (sums.visits().size() != model.q.size()) throw RunError("the sums to learn from have no visits");
    visits_.resize(model.q.size());
    double recorded = 0;
    for (std::size_t c = region * std::size_t{kStrata}; c < (region + 1) * std::size_t{kStrata}; ++c) {
        const auto sum = static_cast<double>(sums.cells()[c]);
        const double before = kKeptEvidence * visits_[c];
        recorded += sum;
        visits_[c] = before + static_cast<double>(sums.visits()[c]);
        if (visits_[c] == 0) continue;
        const double q = (double{model.q[c]} * before + std::ldexp(sum, model.quantum_exponent[region])) / visits_[c];
        next.q[c] = static_cast<float>(std::min(q, double{std::numeric_limits<float>::max()}));
    }
    return recorded;
}

void QTableCells::write(ByteWriter& out, const QTableModel& model) {
    out.put_array(std::span<const float>(model.q));
}

void QTableCells::read(ByteReader& in, std::uint32_t regions, QTableModel& model) {
    model.q = in.get_array<float>();
    if (model.q.size() != std::size_t{regions} * kStrata)
        throw FormatError("a table's strata do not match its regions");
    for (const float q : model.q)
        if (!(q >= 0.0f && std::isfinite(q))) throw FormatError("a radiance of a table is out of range");
}

}  // namespace treefarm
