// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "cli/inspect_points.h"
#include "common/guiding/regions/model_statistics.h"

namespace treefarm {

/// A map over the film.
struct MapReport {
    std::string kind;  ///< "regions", "bsdf-fraction", "view-fraction", "cells"
    std::string file;  ///< path of the picture
    double white = 0;  ///< value shown as white; 0: colours are no numbers
    double mean = 0;   ///< over the pixels that have a value
};

/// Results of `treefarm inspect`.
struct InspectReport {
    std::string directory;
    TreeStatistics statistics;
    std::vector<double> next_event;  ///< fraction of the regions by kNextEventSamples; empty: not decided
    std::vector<PointReport> points;
    std::vector<MapReport> maps;
};

void print_text(const InspectReport& report, std::ostream& out);
void print_json(const InspectReport& report, std::ostream& out);

}  // namespace treefarm
