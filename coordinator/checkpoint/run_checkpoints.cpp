// SPDX-License-Identifier: Apache-2.0
#include "coordinator/checkpoint/run_checkpoints.h"

#include <algorithm>
#include <utility>

#include "common/base/timer.h"
#include "common/config/parse_text.h"
#include "coordinator/last_files.h"

namespace treefarm {

namespace {

/// What checkpoints may take: of this process's time a hundredth, of the disk's a tenth.
constexpr double kInterval = 100.0;
constexpr Pace kPace{0.0, 10.0};
/// How long the end tries to write what it could not.
constexpr double kPatience = 1.0;

}  // namespace

RunCheckpoints::RunCheckpoints(const std::filesystem::path& run, const Job& job, CheckpointOrigin origin,
                               const LoadedCheckpoint* resumed)
    : folder_(run / kCheckpointFolder),
      interval_(job.farm.checkpoint_seconds),
      keeps_(interval_ > 0 && job.output.keep_checkpoint),
      has_any_(interval_ > 0 || resumed),
      origin_(std::move(origin)),
      store_(run, resumed),
      written_passes_(resumed ? resumed->state.reports.size() : 0),
      next_(interval_) {}

bool RunCheckpoints::is_due(double elapsed_seconds) const {
    return interval_ > 0 && elapsed_seconds >= next_ && written_ == prepared_;
}

void RunCheckpoints::offer(RenderState& state, double elapsed_seconds) {
    if (interval_ == 0 || elapsed_seconds < next_) return;
    const Timer timer;
    if (written_ == prepared_) last_prepared_ = {};  // no two copies of what is on disk
    try {
        last_prepared_ = [this, write = store_.prepare(origin_of(state), state), passes = state.reports.size(),
                          number = prepared_ + 1] {
            write();
            written_passes_ = passes;
            written_ = number;
        };
        ++prepared_;
        writer_.put("checkpoint", last_prepared_, kPace);
    } catch (const std::bad_alloc&) {  // the next one may find room
    }
    next_ = elapsed_seconds + std::max(interval_, kInterval * timer.seconds());
}

void RunCheckpoints::take_last(RenderState state) {
    if (interval_ > 0) last_state_ = std::move(state);
}

CheckpointOrigin RunCheckpoints::origin_of(const RenderState& state) const {
    CheckpointOrigin origin = origin_;
    origin.pixels = state.partial ? state.partial->done.pixel_count() : state.films.front().pixels.size();
    return origin;
}

std::string RunCheckpoints::finish(bool done) {
    if (!has_any_) return "";
    if (done && !keeps_) {
        store_.remove();
        return "";
    }
    if (interval_ == 0) return "";
    const bool has_all = last_state_ && !last_state_->partial && written_passes_ >= last_state_->reports.size();
    if (has_all || (!last_state_ && !last_prepared_)) return "";
    std::vector<LastFile> file = {{folder_.string(), [this] {
                                       if (last_state_)
                                           store_.write(origin_of(*last_state_), *last_state_);
                                       else
                                           last_prepared_();
                                   }}};
    const std::vector<std::string> failures = write_last_files(file, kPatience);
    last_state_.reset();
    if (failures.empty()) return "";
    return "no checkpoint of the end: " + failures.front() + "; " +
           (done ? "the image is whole, but no samples can be added to it: for more, free space and "
                 : "what the one before it has is kept; or, with more space, ") +
           "render again: treefarm render " + shell_quoted((folder_.parent_path() / "job.toml").string());
}

}  // namespace treefarm
