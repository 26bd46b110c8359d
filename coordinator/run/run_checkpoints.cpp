// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/run_checkpoints.h"

#include <algorithm>
#include <utility>

#include "common/base/text/parse_text.h"
#include "common/base/timer.h"
#include "common/runs/run_files.h"
#include "coordinator/run/last_files.h"

namespace treefarm {

namespace {

/// Least interval of checkpoints, as a multiple of this process's time for one: at most a hundredth of its time is
/// used. kPace: at most a tenth of the disk's time.
constexpr double kInterval = 100.0;
constexpr Pace kPace{0.0, 10.0};
/// Seconds for which the end of a run retries a failed write.
constexpr double kPatience = 1.0;

}  // namespace

RunCheckpoints::RunCheckpoints(const std::filesystem::path& run, std::function<void()> renew, const Job& job,
                               CheckpointOrigin origin, const LoadedCheckpoint* resumed)
    : folder_(run / kCheckpointFolder),
      renew_(std::move(renew)),
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
    if (written_ == prepared_) last_prepared_ = {};  // frees the second copy of a checkpoint that is on disk
    try {
        last_prepared_ = [this, write = store_.prepare(origin_of(state), state), passes = state.reports.size(),
                          number = prepared_ + 1] {
            renew_();
            write();
            written_passes_ = passes;
            written_ = number;
        };
        ++prepared_;
        writer_.put("checkpoint", last_prepared_, kPace);
    } catch (const std::bad_alloc&) {  // the next checkpoint may find enough memory
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
                                       renew_();
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
           "render again: treefarm render " + shell_quoted((folder_.parent_path() / kJobFile).string());
}

}  // namespace treefarm
