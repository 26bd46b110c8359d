// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/decide/decisions.h"
#include "common/film/combine.h"
#include "common/film/error_estimate.h"
#include "common/guiding/any_guide.h"
#include "common/plan/forecast/forecast.h"
#include "common/plan/schedule/schedule.h"
#include "coordinator/farm/collector.h"

namespace treefarm {

/// Statistics of a figure over the workers.
struct Spread {
    double min = 0, mean = 0, max = 0;
    int max_worker = 0;  ///< the worker with the maximum
};

/// Size of a guide's model.
struct TreeFigures : ModelFigures {
    std::uint64_t bytes = 0;   ///< encoded
    std::uint64_t memory = 0;  ///< on a worker: sampling form and sums
};
TreeFigures tree_figures(const AnyModel& model, std::uint64_t encoded_bytes);

/// Time of a pass by activity: wall-clock seconds of the coordinator, unless stated otherwise.
struct PassSeconds {
    double all = 0;
    double broadcast = 0;          ///< until the last worker had the tree, had built its guide, and requested units
    double collect = 0;            ///< from then on, until the last result arrived
    double merge = 0;              ///< decoding and adding results
    double refine = 0;             ///< building the next tree
    double film = 0;               ///< combining the images of the passes
    double error = 0;              ///< estimating the error, and computing the pass's figures
    Spread trace;                  ///< thread-seconds tracing, per worker
    double splat = 0;              ///< thread-seconds adding records, all workers
    std::map<int, double> worker;  ///< thread-seconds tracing and adding records, per worker
    std::map<int, double> busy;    ///< thread-seconds with a unit, per worker; not of a part before a resume
    double idle = 0;               ///< thread-seconds without a unit

    /// Fraction of the processors' time that a worker's threads got while they had a unit; no value if unknown.
    std::optional<double> processor_share(int number) const;

    /// Seconds of the coordinator's clock, by name.
    std::map<std::string, double> phases() const {
        return {{"broadcast", broadcast}, {"collect", collect}, {"merge", merge},
                {"refine", refine},       {"film", film},       {"error", error}};
    }
};

/// Figures of one finished pass.
struct PassReport {
    PassPlan plan;
    std::uint32_t spp_done = 0;  ///< including this pass
    std::size_t workers = 0;
    std::uint32_t threads = 0;
    PassSeconds seconds;
    TraceStats stats;
    PassVariance variance;
    ErrorEstimate error;           ///< of the image including this pass
    Decisions::Figures decisions;  ///< verdicts after this pass, with their basis
    double run_seconds = 0;        ///< since the first worker requested units, including this pass
    ErrorForecast halving;         ///< until half of the present error
    ErrorForecast target;          ///< until budget.error; relative_error is 0 without that budget
    TreeFigures tree;              ///< of the tree that guided the pass
    std::uint64_t update_bytes = 0, touched_cells = 0;
    UpdateCaps caps;
    SplatCaps splat_caps;
    std::uint64_t splat_bytes = 0, saturated_splats = 0;
    RefineReport refine;  ///< on the tree that this pass taught

    /// Light samples per vertex at which emitters may be sampled.
    double next_event_samples() const;
    double nonzero_share() const;
    double core_seconds() const;  ///< of the workers' threads, tracing and recording
    /// Core-seconds until the image has unit variance, at this pass's stuv and speed.
    double ttuv() const;
    /// 1 / (mean squared error x run_seconds) of the image including this pass; 0 if the error is unknown or zero.
    double efficiency() const;
    double rays_per_second() const;
};

/// Fills in the figures of a pass over `model` from its collected results, without its variance.
void fill_from_collector(PassReport& report, const Collector& collector, const AnyModel& model);

/// Computes seconds.idle from seconds.all and the other figures.
void count_idle(PassReport& report);

}  // namespace treefarm
