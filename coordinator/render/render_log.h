// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "coordinator/render/render_observer.h"
#include "coordinator/render/render_request.h"
#include "coordinator/run/run_report.h"
#include "coordinator/words/processor_time.h"

namespace treefarm {

/// Log of a render, line by line: to its observer and to the run directory's log.txt.
class RenderLog {
  public:
    /// `request` must outlive it.
    RenderLog(const RenderRequest& request, std::filesystem::path folder, const TellMessage& tell);

    const Log& log() const { return log_; }
    /// Logs the command, and messages of the readers.
    void tell_origin() const;
    /// Logs the start of the render, or the state that it resumes.
    void tell_start(const RenderState& state, const NextPass& first) const;
    /// Logs a pass. `pass_count`: of all passes; 0: unknown.
    void tell_pass(const PassReport& pass, const CombinedImage& image, std::size_t pass_count);
    /// Logs the end. `continued`: false: interrupted before it resumed its checkpoint. `part`: finished fraction of the
    /// last pass, 0 to 1. `has_previous`: an earlier run is set aside in the folder.
    void tell_end(const RunEnd& end, const RenderResult& result, bool continued, double part, bool has_previous);

    /// Options that tell --debug-sample the passes, and the checkpoint.
    std::string replay_options() const;

  private:
    void tell_if_starved(const PassReport& pass);
    void tell_if_black(const CombinedImage& image, std::uint32_t spp);
    void tell_result(const RenderResult& result, double elapsed_seconds);
    std::string budget_text(const NextPass& first) const;
    std::string kept_text(const RenderResult& result, double part) const;
    std::string why_missed(const RenderResult& result) const;

    const RenderRequest& request_;
    const std::filesystem::path folder_;  ///< run directory
    const Log log_;
    bool reported_black_ = false;
    std::map<int, ProcessorTime> processor_time_;  ///< by worker, of all passes
};

/// Whether a result's error is above the request's target.
bool missed_target(const RenderRequest& request, const RenderResult& result);

}  // namespace treefarm
