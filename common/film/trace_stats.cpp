// SPDX-License-Identifier: Apache-2.0
#include "common/film/trace_stats.h"

#include <algorithm>

#include "common/film/splat_film.h"
#include "common/math/saturating.h"

namespace treefarm {

void SplittingSums::add(const SplittingSums& other) {
    add_saturating(split_mean, other.split_mean);
    add_saturating(unsplit_mean, other.unsplit_mean);
    add_saturating(split_variance, other.split_variance);
    add_saturating(unsplit_variance, other.unsplit_variance);
}

void LightSubpathSums::add(const LightSubpathSums& other) {
    add_saturating(samples, other.samples);
    add_saturating(both_mean, other.both_mean);
    add_saturating(alone_mean, other.alone_mean);
    add_saturating(both_variance, other.both_variance);
    add_saturating(alone_variance, other.alone_variance);
    add_saturating(alone_rays, other.alone_rays);
}

void EmissionSums::add(const EmissionSums& other) {
    if (other.paths.empty()) return;
    paths.resize(std::max(paths.size(), other.paths.size()));
    squares.resize(paths.size());
    for (std::size_t i = 0; i < other.paths.size(); ++i) {
        paths[i] += other.paths[i];
        squares[i] = std::min(squares[i] + other.squares[i], kMostSplatSum);
    }
}

void TraceStats::add(const TraceStats& other) {
    paths += other.paths;
    nonzero_paths += other.nonzero_paths;
    rays += other.rays;
    shadow_rays += other.shadow_rays;
    vertices += other.vertices;
    records += other.records;
    split_path_rays += other.split_path_rays;
    invalid_samples += other.invalid_samples;
    for (std::size_t i = 0; i < kNextEventSums; ++i)
        add_saturating(next_event[i], other.next_event[i]);
    splitting.add(other.splitting);
    unguided.add(other.unguided);
    light_subpaths.add(other.light_subpaths);
    emission.add(other.emission);
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
