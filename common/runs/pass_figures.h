// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

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

/// Figures of a pass, in the order of the columns. An empty field or null: unknown.
inline constexpr PassFigure kPassFigures[] = {
    {"pass", "number", kAll, "number of the pass, from 1"},
    {"spp", "samples/pixel", kAll, "samples of this pass"},
    {"spp_done", "samples/pixel", kAll, "samples with this pass"},
    {"next_event", "0 or 1", kInTable, "paths sampled emitters directly"},
    {"next_event_samples", "1/vertex", kAll, "light samples per vertex", "next_event_n"},
    {"next_event_low", "fraction", kAll, "vertices that have a light sample at 1 in 16 only"},
    {"next_event_work_ratio", "ratio", kAll, "work over that with a light sample at each vertex", "next_event_saved"},
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
    {"guided", "0 or 1", kAll, "paths were guided"},
    {"guiding_efficiency", "ratio", kAll, "unguided work over guided; 0: not known", "worth guiding_worth"},
    {"guiding_efficiency_low", "ratio", kAll, "less one standard error", "worth_low guiding_worth_low"},
    {"guiding_efficiency_high", "ratio", kAll, "plus one standard error", "worth_high guiding_worth_high"},
    {"guiding_efficiency_groups", "count", kInTable, "groups of pixels, of 64, that it rests on", "worth_known"},
    {"unguided_variance", "number", kInTable, "variance that an unguided sample would have"},
    {"split", "0 or 1", kAll, "paths were split"},
    {"splitting_variance_ratio", "ratio", kAll, "variance of unsplit samples over that of split ones",
     "splitting_quietens"},
    {"splitting_ray_ratio", "ratio", kAll, "rays of split samples over those of unsplit ones", "splitting_rays"},
    {"splitting_mean_ratio", "ratio", kAll, "mean of unsplit samples over that of split ones", "splitting_found"},
    {"light_subpaths", "0 or 1", kAll, "light subpaths were traced"},
    {"light_subpaths_variance_ratio", "ratio", kAll, "variance without light subpaths over that with them",
     "light_subpaths_quieten"},
    {"light_subpaths_ray_ratio", "ratio", kAll, "rays with light subpaths over those without", "light_subpaths_rays"},
    {"camera_paths_mean_ratio", "ratio", kAll, "mean without light subpaths over that with them", "camera_paths_found"},
    {"emitters", "count", kAll, "emitters that light paths may start from, where that is learned"},
    {"emitters_of_half", "count", kAll, "the fewest of them that started half of the light paths"},
    {"tree_views", "count", kAll, "views of the tree"},
    {"tree_cells", "count", kAll, "cells of the tree"},
    {"spatial_depth", "count", kInTable, "depth of the spatial tree"},
    {"directional_depth", "count", kInTable, "greatest depth of a directional tree"},
    {"tree_bytes", "bytes", kAll, "the tree, encoded"},
    {"tree_memory", "bytes", kAll, "the tree and its sums, on a worker"},
    {"update_bytes", "bytes", kAll, "updates of the tree that workers sent"},
    {"touched_cells", "count", kInTable, "cells in these updates"},
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

/// Present name of a figure from the name written by this or an earlier version; other names are returned unchanged.
std::string_view current_name(std::string_view written);

}  // namespace treefarm
