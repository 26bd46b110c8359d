// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/decide/decisions.h"
#include "common/film/trace_stats.h"

namespace treefarm {

/// Figures of tracing some units, with what decisions learn from them.
struct UnitStats : TraceStats {
    Decisions::Evidence decided;  ///< sums that no decision needs in this pass stay 0

    /// Sums of one decision.
    template <class Sums>
    Sums& sums() {
        return decided.get<Sums>();
    }
    template <class Sums>
    const Sums& sums() const {
        return decided.get<Sums>();
    }
    void add(const UnitStats& other) {
        TraceStats::add(other);
        decided.add(other.decided);
    }
};

}  // namespace treefarm
