// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <ostream>
#include <string>

#include "common/plan/forecast/expectation.h"
#include "coordinator/study/cell_request.h"

namespace treefarm {

/// Expected core-seconds of a render; unknown: nothing. `name` is that of its scene and method: renders of one name
/// differ by budget and seed alone.
using CostOfRender = std::function<std::optional<Expected>(RenderRequest& request, const std::string& name)>;

/// Expected core-seconds of a study's missing renders.
struct StudyCost {
    Expected cells, references;  ///< warm-ups are among the cells
    std::size_t unknown = 0;     ///< number of renders that are not counted
};

/// Prints the cells in their order of rendering, and which of them exist. Returns what the others and the missing
/// references cost by `cost`, which is asked once for each scene, method and budget.
StudyCost list_cells(const Study& study, const RenderOrigin& origin, const CostOfRender& cost, std::ostream& out);

/// Cost in words: "about 12:00 [10:00, 14:30] of a core for the cells, 4:00 [3:20, 4:50] for the references".
std::string cost_text(const StudyCost& cost);

}  // namespace treefarm
