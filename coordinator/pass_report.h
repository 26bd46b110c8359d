// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/film/combine.h"
#include "common/film/error_estimate.h"
#include "common/film/guiding_efficiency.h"
#include "common/film/trace_stats.h"
#include "common/guiding/any_guide.h"
#include "common/plan/forecast.h"
#include "common/plan/schedule.h"
#include "coordinator/collector.h"

namespace treefarm {

/// A figure over the workers.
struct Spread {
    double min = 0, mean = 0, max = 0;
    int max_worker = 0;  ///< that attains the maximum
};

/// Size of a guide's model.
struct TreeFigures : ModelFigures {
    std::uint64_t bytes = 0;   ///< encoded
    std::uint64_t memory = 0;  ///< on a worker: sampling form and sums
};
TreeFigures tree_figures(const AnyModel& model, std::uint64_t encoded_bytes);

/// Where the time of a pass went: seconds of the wall clock on the coordinator, unless said otherwise.
struct PassSeconds {
    double all = 0;
    double broadcast = 0;          ///< until the last worker had the tree, its guide built, and asked for work
    double collect = 0;            ///< from then on, until the last result was in
    double merge = 0;              ///< decoding and adding results
    double refine = 0;             ///< building the next tree
    double film = 0;               ///< combining the images of the passes
    double error = 0;              ///< estimating the error, and the figures of the pass
    Spread trace;                  ///< thread-seconds tracing, per worker
    double splat = 0;              ///< thread-seconds adding records, all workers
    std::map<int, double> worker;  ///< thread-seconds tracing and adding records, per worker
    double idle = 0;  ///< thread-seconds in which threads neither traced nor added, or waited for a processor

    /// Seconds of the coordinator's clock, by name.
    std::map<std::string, double> phases() const {
        return {{"broadcast", broadcast}, {"collect", collect}, {"merge", merge},
                {"refine", refine},       {"film", film},       {"error", error}};
    }
};

/// Everything worth knowing of one finished pass.
struct PassReport {
    PassPlan plan;
    std::uint32_t spp_done = 0;  ///< with this pass
    std::size_t workers = 0;
    std::uint32_t threads = 0;
    PassSeconds seconds;
    TraceStats stats;
    PassVariance variance;
    ErrorEstimate error;                   ///< of the image with this pass
    GuidingEfficiency guiding_efficiency;  ///< by which guiding is judged after this pass
    Guiding guiding = Guiding::open;       ///< what is known with this pass
    SplittingGain splitting_gain;          ///< of a guided pass that taught and may split
    bool splitting = true;                 ///< whether it may pay, with this pass
    LightSubpathGain light_subpath_gain;   ///< of a pass that compared
    bool light_subpaths = true;            ///< whether they may pay, with this pass
    std::uint64_t emitters = 0;            ///< that light paths may start from, where passes learn how often
    std::uint64_t emitters_of_half = 0;    ///< of which the fewest started half of this pass's light paths
    NextEventPrice price;                  ///< of a pass just finished: next event is decided by it
    double run_seconds = 0;                ///< since the first worker asked for work, with this pass
    ErrorForecast halving;                 ///< until the error is half of this
    ErrorForecast target;                  ///< until it is budget.error; its relative_error is 0 where there is none
    TreeFigures tree;                      ///< that guided the pass
    std::uint64_t update_bytes = 0, touched_cells = 0;
    UpdateCaps caps;
    SplatCaps splat_caps;
    std::uint64_t splat_bytes = 0, saturated_splats = 0;
    RefineReport refine;  ///< of the tree that this pass taught

    /// Light samples per vertex that might have had one.
    double next_event_samples() const;
    double nonzero_share() const;
    /// Whether samples of this pass join paths from lamps to those of the camera.
    bool has_light_subpaths() const {
        return plan.light_subpaths && plan.layers.estimates && plan.layers.splats.pixels > 0;
    }
    double core_seconds() const;  ///< of the workers' threads, tracing and recording
    /// Core-seconds until the image has unit variance, at this pass's stuv and speed.
    double ttuv() const;
    /// 1 / (mean squared error x run_seconds) of the image with this pass; 0 where the error is not known or zero.
    double efficiency() const;
    double rays_per_second() const;
};

/// Figures of a pass from what was collected, but for its variance.
void fill_from_collector(PassReport& report, const Collector& collector);

/// seconds.idle, once seconds.all and the figures are there.
void count_idle(PassReport& report);

/// passes.csv: the header line and the line of a pass, without line ends.
std::string pass_csv_header();
std::string pass_csv_line(const PassReport& report);

/// "firm", "noisy", "learning", or empty.
const char* trust_name(Trust trust);

}  // namespace treefarm
