// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "serve/file_json.h"

namespace treefarm {

/// Content type of metrics_text().
inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// Figures of runs (run_view()) in Prometheus' text format (prometheus.io, "Exposition formats", 0.0.4). Seconds,
/// fractions from 0 to 1 ("ratio"), counts ("total"); unknown figures are omitted.
std::string metrics_text(const std::vector<FileJson>& runs);

}  // namespace treefarm
