#pragma once

#include <vector>

#include "common/config/job.h"
#include "common/film/error_estimate.h"

namespace treefarm {

/// What a finished pass tells about those to come. Seconds are of the coordinator's clock.
struct PassFacts {
    std::uint32_t spp = 0;
    std::uint32_t spp_before = 0;
    double mse_of_sample = 0;     ///< PassVariance::mse_of_sample
    double trace_seconds = 0;     ///< what grows with spp, without adding records
    double overhead_seconds = 0;  ///< what does not: broadcast, refinement, combination
};

/// A render between two passes.
struct RenderState {
    std::vector<PassFacts> passes;  ///< the finished ones
    double seconds = 0;             ///< spent since the first worker asked for work
    ErrorEstimate error;            ///< of the image so far

    std::uint32_t spp() const { return passes.empty() ? 0 : passes.back().spp_before + passes.back().spp; }
};

/// Whether the image is its last pass alone.
bool shows_last_pass_only(const Job& job);

/// Samples per pixel that one further pass needs until the image's mean squared error is `mse`, if they are as good as
/// those of the last pass (docs/guiding.md, "error"). 0: it is there already. Infinite: not known yet.
double spp_to_reach(const RenderState& state, const Job& job, double mse);

/// Wall-clock seconds of a further pass, by the last passes' time per sample. Needs a finished pass.
double seconds_per_spp(const RenderState& state);
double seconds_of_pass(const RenderState& state, double spp);

/// What it takes beyond what is done to come down to an error.
struct ErrorForecast {
    double relative_error = 0;
    double spp = 0;      ///< infinite: not known
    double seconds = 0;  ///< of the clock; infinite: not known
};
ErrorForecast forecast_error(const RenderState& state, const Job& job, double relative_error);

}  // namespace treefarm
