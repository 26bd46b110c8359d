// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "coordinator/render/render_observer.h"
#include "coordinator/render/render_request.h"
#include "coordinator/run/run_report.h"

namespace treefarm {

/// Log of a render: lines for its observer and for log.txt in the run directory.
class RenderLog {
  public:
    /// `request` outlives it.
    RenderLog(const RenderRequest& request, std::filesystem::path folder, const TellMessage& tell);

    const Log& log() const { return log_; }
    /// Logs the command and the readers' warnings.
    void tell_origin() const;
    /// Logs scene, size and budget, and the samples of a checkpoint.
    void tell_start(const RenderState& state, const NextPass& first) const;
    /// `pass_count`: of all; 0: not known.
    void tell_pass(const PassReport& pass, const CombinedImage& image, std::size_t pass_count);
    /// `continued`: false: interrupted before anything of its checkpoint was continued. `part`: of the pass that was
    /// not finished, 0 to 1. `has_previous`: an earlier run lies aside in the folder.
    void tell_end(const RunEnd& end, const RenderResult& result, bool continued, double part, bool has_previous);

    /// The options that make the passes known to --debug-sample, and the checkpoint.
    std::string replay_options() const;

  private:
    void tell_if_black(const CombinedImage& image, std::uint32_t spp);
    void tell_result(const RenderResult& result, double elapsed_seconds);
    std::string budget_text(const NextPass& first) const;
    std::string kept_text(const RenderResult& result, double part) const;
    std::string why_missed(const RenderResult& result) const;

    const RenderRequest& request_;
    const std::filesystem::path folder_;  ///< run directory
    const Log log_;
    bool reported_black_ = false;
};

/// Whether a result's error is above the one that was asked for.
bool missed_target(const RenderRequest& request, const RenderResult& result);

}  // namespace treefarm
