// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coordinator/passes/pass_report.h"

namespace treefarm {

/// A decision as it stands after a pass, in a line for strangers: what, what it saves, how sure that is, and why.
struct DecisionText {
    const char* subject;  ///< which decision: "guiding", "next event", "splitting", "light subpaths"
    std::string words;
};

/// What is decided with a pass; nothing of a decision where nothing is known, or all is as usual.
std::vector<DecisionText> decision_texts(const PassReport& report);

}  // namespace treefarm
