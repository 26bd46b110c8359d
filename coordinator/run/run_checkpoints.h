// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/config/job.h"
#include "coordinator/checkpoint/checkpoint_store.h"
#include "coordinator/run/file_writer.h"

namespace treefarm {

/// The checkpoints of one run: which passes get one, written beside the render, and what stays at its end.
class RunCheckpoints {
  public:
    /// `origin`: of all of them, but for the pixels. `resumed`: what the run goes on from, or nullptr.
    RunCheckpoints(const std::filesystem::path& run, const Job& job, CheckpointOrigin origin,
                   const LoadedCheckpoint* resumed);

    /// Whether one is due within a pass: not while the last is being written, so that there are never three of them.
    bool is_due(double elapsed_seconds) const;
    /// A checkpoint, where one is due; called after each pass, and within one by is_due().
    void offer(RenderState& state, double elapsed_seconds);
    /// The state that the run ends in, for a checkpoint that finish() writes.
    void take_last(RenderState state);

    /// Ends what is being written; what waits is forgotten.
    void stop() { writer_.stop(); }
    /// Writes the last one, after stop(), unless it is there or nobody wants it. A run that is `done` and keeps none
    /// loses those that there are. Returns what went wrong, which decides nothing: the image is there.
    std::string finish(bool done);

    std::vector<std::string> take_news() { return writer_.take_news(); }

  private:
    CheckpointOrigin origin_of(const RenderState& state) const;

    const std::filesystem::path folder_;
    const double interval_;  ///< seconds between two; 0: none are written
    const bool keeps_;       ///< the last one, when the run is done
    const bool has_any_;     ///< of this run or of what it goes on from
    const CheckpointOrigin origin_;
    CheckpointStore store_;
    std::function<void()> last_prepared_;          ///< the last one that was given to the writer
    std::optional<RenderState> last_state_;        ///< that the run ended in
    std::atomic<std::size_t> written_passes_ = 0;  ///< of the last one that is on disk
    std::uint64_t prepared_ = 0;                   ///< number of the last one that was given to the writer
    std::atomic<std::uint64_t> written_ = 0;       ///< of the last one that it has written
    double next_;                                  ///< not before, in elapsed seconds
    FileWriter writer_;                            ///< of its own: nothing waits for gigabytes. Last: it ends first
};

}  // namespace treefarm
