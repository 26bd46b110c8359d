// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coordinator/passes/pass_report.h"

namespace treefarm {

/// A decision after a pass in one line of plain words: the decision, its saving, its certainty, its reason.
struct DecisionText {
    const char* subject;  ///< name of the decision: "guiding", "next event", "splitting", "light subpaths"
    std::string words;
};

/// Decisions after a pass; without those of which nothing is known, or which are as usual.
std::vector<DecisionText> decision_texts(const PassReport& report);

}  // namespace treefarm
