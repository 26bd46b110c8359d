// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include "common/decide/decisions.h"

namespace treefarm {

/// Figures of a pass before and after those of the decisions.
inline constexpr PassFigure kFirstFigures[] = {
    {"pass", "number", kAll, "number of the pass, from 1"},
    {"spp", "samples/pixel", kAll, "samples of this pass"},
    {"spp_done", "samples/pixel", kAll, "samples with this pass"},
    {"next_event", "0 or 1", kInTable, "paths sampled emitters directly"},
    {"next_event_samples", "1/vertex", kAll, "light samples per vertex", "next_event_n"},
    {"record", "0 or 1", kInTable, "the pass taught the guiding tree"},
    {"workers", "count", kInTable, "workers of the pass"},
    {"threads", "count", kInTable | kInCell, "threads of all workers"},
    {"seconds", "s", kAll, "time of the pass"},
    {"broadcast_seconds", "s", kInTable, "until the last worker had the tree and asked for work"},
    {"trace_seconds_min", "thread-s", kInTable, "tracing, of the worker with the least"},
    {"trace_seconds_mean", "thread-s", kInTable, "tracing, mean of the workers"},
    {"trace_seconds_max", "thread-s", kInTable, "tracing, of the worker with the most"},
    {"trace_max_worker", "number", kInTable, "number of that worker"},
    {"profile_intersect", "thread-s", kInTable, "intersecting rays, where it was timed"},
    {"profile_surface", "thread-s", kInTable, "preparing surfaces, where it was timed"},
    {"profile_direction", "thread-s", kInTable, "sampling directions, where it was timed"},
    {"profile_shadow", "thread-s", kInTable, "shadow rays, where it was timed"},
    {"profile_record", "thread-s", kInTable, "recording for the tree, where it was timed"},
    {"splat_seconds", "thread-s", kInTable, "adding records to the tree's sums"},
    {"idle_seconds", "thread-s", kInTable | kInCell, "threads waited for units"},
    {"busy_seconds", "thread-s", kInTable, "threads had a unit, with or without a processor"},
    {"merge_seconds", "s", kInTable, "decoding and adding results, on the coordinator"},
    {"refine_seconds", "s", kInTable, "building the next tree"},
    {"film_seconds", "s", kInTable, "combining the images of the passes"},
    {"error_seconds", "s", kInTable, "estimating the error"},
    {"run_seconds", "s", kAll, "since the first worker asked for work, with this pass"},
    {"core_seconds", "thread-s", kAll, "tracing and recording; in cell.json of all passes so far"},
    {"stuv", "samples/pixel", kAll, "until unit variance: the mean variance of one sample"},
    {"stuv_trimmed", "samples/pixel", kAll, "stuv without the worst 0.1 % of the pixels"},
    {"stuv_ppg", "samples/pixel", kAll, "stuv as the program of Mueller et al. counts it"},
    {"ttuv", "thread-s", kAll, "time until the image has unit variance"},
    {"error", "ratio", kInTable, "RMSE of the image over its mean, with this pass, as estimated"},
    {"error_low", "ratio", kInTable, "lower end of its 95 % interval"},
    {"error_high", "ratio", kInTable, "upper end of its 95 % interval"},
    {"estimated_rmse", "radiance", kInTable, "RMSE of the image, as estimated"},
    {"efficiency", "1/(radiance^2 s)", kAll, "1 / (mean squared error x run_seconds)"},
    {"halving_spp", "samples/pixel", kInTable, "samples until the error is half of this"},
    {"halving_seconds", "s", kInTable, "time until the error is half of this"},
    {"halving_trust", "word", kInTable, "firm, noisy or learning (an upper bound)"},
    {"target_spp", "samples/pixel", kInTable, "samples until the error is budget.error"},
    {"target_seconds", "s", kInTable, "time until the error is budget.error"},
    {"target_trust", "word", kInTable, "as halving_trust"},
    {"paths", "count", kInTable, "camera and light paths"},
    {"nonzero_share", "fraction", kAll, "paths that carried radiance"},
    {"rays", "count", kInTable | kInCell, "closest-hit rays"},
    {"shadow_rays", "count", kInTable | kInCell, "rays of visibility alone"},
    {"rays_per_second", "1/s", kAll, "rays and shadow rays over seconds"},
    {"vertices", "count", kInTable, "vertices at which a direction was sampled"},
    {"records", "count", kInTable, "vertices recorded for the tree"},
    {"invalid_samples", "count", kAll, "samples left out, since they were no numbers"},
    {"tree_nodes", "count", kAll, "nodes of the spatial tree that guided the pass"},
    {"tree_regions", "count", kAll, "its regions"},
};
inline constexpr PassFigure kLastFigures[] = {
    {"tree_views", "count", kAll, "views of the tree"},
    {"tree_cells", "count", kAll, "cells of the tree"},
    {"spatial_depth", "count", kInTable, "depth of the spatial tree"},
    {"directional_depth", "count", kInTable, "greatest depth of a directional tree"},
    {"tree_bytes", "bytes", kAll, "the tree, encoded"},
    {"tree_memory", "bytes", kAll, "the tree and its sums, on a worker"},
    {"update_bytes", "bytes", kAll, "evidence that workers sent, for the tree and for decisions"},
    {"touched_cells", "count", kInTable, "cells in it, counted once per message"},
    {"capped_records", "count", kInTable, "records above the largest value that is added"},
    {"saturated_cells", "count", kInTable, "sums that reached their largest value"},
    {"outside_positions", "count", kInTable, "vertices outside the tree's cube"},
    {"spatial_depth_capped", "count", kInTable, "regions not split since the tree is too deep"},
    {"directional_depth_capped", "count", kInTable, "cells not split since their tree is too deep"},
    {"memory_capped", "count", kInTable, "regions not split since the tree is too large"},
    {"splat_bytes", "bytes", kInRecords, "splats that workers sent"},
    {"phase_seconds", "s", kInRecords, "by phase: broadcast, collect, merge, refine, film, error", "phases"},
    {"trace_seconds", "thread-s", kInRecords, "min, mean and max of the workers, and max_worker"},
    {"image_error", "object", kInRecords, "estimated error with this pass, as at the top of summary.json", "estimate"},
    {"halving", "object", kInRecords, "forecast until half of this error, as at the top of summary.json"},
    {"target", "object", kInCell, "forecast until budget.error, alike"},
    {"worker_seconds", "thread-s", kInCell, "tracing and recording, by worker"},
};

/// Figures of a pass, in the order of the columns. An empty field or null: unknown.
inline constexpr auto kPassFigures = [] {
    std::array<PassFigure, std::size(kFirstFigures) + Decisions::kFigures.size() + std::size(kLastFigures)> all{};
    auto next = std::copy(std::begin(kFirstFigures), std::end(kFirstFigures), all.begin());
    next = std::copy(Decisions::kFigures.begin(), Decisions::kFigures.end(), next);
    std::copy(std::begin(kLastFigures), std::end(kLastFigures), next);
    // As in files of earlier versions, the columns of next event follow next_event_samples.
    const auto named = [&all](std::string_view name) {
        return std::find_if(all.begin(), all.end(), [name](const PassFigure& f) { return f.name == name; });
    };
    const auto low = named(std::begin(NextEventDecision::kColumns)->figure.name);
    std::rotate(named("next_event_samples") + 1, low, low + std::size(NextEventDecision::kColumns));
    return all;
}();

/// Present name of a figure from the name written by this or an earlier version; other names are returned unchanged.
std::string_view current_name(std::string_view written);

}  // namespace treefarm
