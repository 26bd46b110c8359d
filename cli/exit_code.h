// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/run/run_report.h"

namespace treefarm {

/// Exit code of a render, or of a series of them (kExitCodesText).
constexpr int exit_code_of(RunState state, bool missed_target = false) {
    switch (state) {
        case RunState::done:
            return missed_target ? 4 : 0;
        case RunState::interrupted:
            return 3;
        default:
            return 1;
    }
}

}  // namespace treefarm
