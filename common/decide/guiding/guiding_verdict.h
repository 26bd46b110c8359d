// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/error.h"
#include "common/decide/guiding/guiding_efficiency.h"
#include "common/decide/pass/pass_plan.h"

namespace treefarm {

/// Verdict on guiding from finished passes; never final.
enum class Guiding {
    open,   ///< it pays, or this is unknown: the next pass is guided
    loses,  ///< the next pass is unguided
};

/// Throws FormatError for a value that is no verdict.
inline void require_known(Guiding verdict) {
    if (verdict > Guiding::loses) throw FormatError("an unknown verdict on guiding");
}

/// Verdict after a guided pass that trained: compares efficiency of guiding times `mistrust` with a limit. `mistrust`:
/// factor by which unguided passes were noisier than guided samples had predicted. `before`: efficiency with the
/// previous tree; if the efficiency has grown, the next tree is expected to gain the same factor again, and that
/// expectation is judged. In doubt passes stay guided: guiding loses at most its cost, unguided paths may lose without
/// bound. Trees of short passes improve in any case, so their limit is lower.
Guiding judge_guiding(const PassPlan& pass, const GuidingEfficiency& efficiency, const GuidingEfficiency& before,
                      double mistrust);

}  // namespace treefarm
