// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>

#include "common/decide/pass/pass_plan.h"

namespace treefarm {

/// Files that have a figure, as bits.
inline constexpr unsigned kInTable = 1;    ///< a column of passes.csv
inline constexpr unsigned kInSummary = 2;  ///< a key in the list `passes` of summary.json
inline constexpr unsigned kInCell = 4;     ///< a key in the list `passes` of a study's cell.json
inline constexpr unsigned kInRecords = kInSummary | kInCell;
inline constexpr unsigned kAll = kInTable | kInRecords;

/// A figure of a finished pass.
struct PassFigure {
    const char* name;
    const char* unit;
    unsigned places;
    const char* meaning;
    const char* former = "";  ///< names in files of earlier versions, separated by spaces
};

/// Value of a figure that a decision reports.
using FigureValue = std::variant<bool, std::uint64_t, double>;

/// A figure that a decision reports, and its value for a pass.
template <class Figures>
struct DecisionColumn {
    PassFigure figure;
    FigureValue (*value)(const PassPlan&, const Figures&);
};

}  // namespace treefarm
