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

/// Checkpoints of one run: which passes are saved, in the background, and which checkpoint is kept at the end.
class RunCheckpoints {
  public:
    /// `renew`: makes the run directory again if it has been removed; throws if it cannot. `origin`: that of every
    /// checkpoint, apart from the pixels. `resumed`: the checkpoint being resumed, or nullptr.
    RunCheckpoints(const std::filesystem::path& run, std::function<void()> renew, const Job& job,
                   CheckpointOrigin origin, const LoadedCheckpoint* resumed);

    /// Whether a checkpoint is due within a pass. False while one is being written, so that there are never three.
    bool is_due(double elapsed_seconds) const;
    /// Writes a checkpoint if one is due; called after each pass, and within one by is_due().
    void offer(RenderState& state, double elapsed_seconds);
    /// Stores the run's final state for the checkpoint that finish() writes.
    void take_last(RenderState state);

    /// Completes the present write, and drops those that wait.
    void stop() { writer_.stop(); }
    /// Writes the final checkpoint, after stop(), unless it exists already or is not wanted. A run that is `done` and
    /// keeps no checkpoint deletes its earlier ones. Returns an error message, which fails nothing: the image exists.
    std::string finish(bool done);

    std::vector<std::string> take_news() { return writer_.take_news(); }

  private:
    CheckpointOrigin origin_of(const RenderState& state) const;

    const std::filesystem::path folder_;
    const std::function<void()> renew_;
    const double interval_;  ///< seconds between checkpoints; 0: none are written
    const bool keeps_;       ///< whether the last one is kept when the run is done
    const bool has_any_;     ///< whether a checkpoint exists, of this run or of the resumed one
    const CheckpointOrigin origin_;
    CheckpointStore store_;
    std::function<void()> last_prepared_;          ///< writes the last checkpoint given to the writer
    std::optional<RenderState> last_state_;        ///< final state of the run
    std::atomic<std::size_t> written_passes_ = 0;  ///< passes in the last checkpoint on disk
    std::uint64_t prepared_ = 0;                   ///< number of the last checkpoint given to the writer
    std::atomic<std::uint64_t> written_ = 0;       ///< number of the last checkpoint that it has written
    double next_;                                  ///< earliest time of the next one, in elapsed seconds
    /// of its own, so that other files do not wait for gigabytes. Last: destroyed first
    FileWriter writer_;
};

}  // namespace treefarm
