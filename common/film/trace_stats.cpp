// SPDX-License-Identifier: Apache-2.0
#include "common/film/trace_stats.h"

namespace treefarm {

void TraceStats::add(const TraceStats& other) {
    paths += other.paths;
    nonzero_paths += other.nonzero_paths;
    rays += other.rays;
    shadow_rays += other.shadow_rays;
    vertices += other.vertices;
    records += other.records;
    split_path_rays += other.split_path_rays;
    invalid_samples += other.invalid_samples;
    for (const InvalidSample& sample : other.first_invalid)
        if (first_invalid.size() < kMaxReported) first_invalid.push_back(sample);
    tails.add(other.tails);
    trace_seconds += other.trace_seconds;
    splat_seconds += other.splat_seconds;
    busy_seconds += other.busy_seconds;
    for (std::size_t i = 0; i < kTracePhases; ++i)
        phase_seconds[i] += other.phase_seconds[i];
}

}  // namespace treefarm
