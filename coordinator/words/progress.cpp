// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/progress.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <utility>

#include "common/base/text/duration_text.h"
#include "coordinator/words/pass_text.h"

namespace treefarm {

namespace {

/// Seconds of preparation above which it is reported.
constexpr double kPreparingSeconds = 1.0;

/// Whole percentage that is 100 only at the end.
std::string percent(double fraction) {
    return fmt::format("{} %", static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0) + 1e-6));
}

bool has_error(const ErrorEstimate& error) {
    return error.known && error.rmse > 0;
}

/// Sets the progress text: by time if the time limit will end the render, else by the error's forecast, else by
/// samples.
void say_how_far(const RenderProgress& p, const Job::Budget& budget, const TimeLeft& left, RenderWords& words) {
    if (budget.error > 0) {
        if (left.known()) words.fraction = p.run_seconds / (p.run_seconds + left.seconds);
        if (has_error(p.error))
            words.how_far =
                fmt::format("error {:.3g} %, wanted {:.3g} %", 100 * p.error.relative(), 100 * budget.error);
        return;
    }
    if (budget.seconds > 0) {
        words.fraction = std::min(1.0, p.run_seconds / budget.seconds);
        words.how_far = percent(words.fraction) + " of " + limit_text(budget.seconds);
    } else if (p.spp_total > 0) {
        words.fraction = p.fraction;
        words.how_far = percent(p.fraction) + fmt::format(" of {} spp", p.spp_total);
    }
    if (has_error(p.error)) words.error = brief_error_text(p.error);
}

}  // namespace

RenderWords render_words(const RenderProgress& p, const Job::Budget& budget, const TimeLeft& left) {
    RenderWords words;
    words.run_seconds = p.run_seconds;
    say_how_far(p, budget, left, words);
    if (left.known()) words.left = left.trust + rough_duration_text(left.seconds) + " left";
    words.pass = pass_name(p.pass, p.pass_count);
    words.since_begin = duration_text(p.run_seconds);
    return words;
}

RenderWords preparing_words(double seconds) {
    RenderWords words;
    words.how_far = "preparing the scene";
    words.since_begin = rough_duration_text(seconds) + " so far";
    return words;
}

Status render_status(const RenderWords& w) {
    Status status;
    status.fraction = w.fraction;
    status.fields = {w.how_far, w.left, w.pass, w.error, w.left.empty() ? w.since_begin : ""};
    status.line = join_fields({w.pass, w.how_far, w.since_begin, w.left});
    return status;
}

Progress::Progress(ConsolePtr console, const Job::Budget& budget, StatusFrame frame)
    : console_(std::move(console)),
      budget_(budget),
      frame_(frame ? std::move(frame) : StatusFrame(render_status)),
      left_(budget) {}

void Progress::update(const RenderProgress& progress) {
    if (progress.run_seconds <= 0) {
        if (const double seconds = clock_.seconds(); seconds > kPreparingSeconds)
            console_->status(frame_(preparing_words(seconds)));
        return;
    }
    console_->status(frame_(render_words(progress, budget_, left_.at(progress))));
}

}  // namespace treefarm
