// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/time_left.h"

#include "coordinator/words/pass_text.h"

namespace treefarm {

namespace {

/// Earlier, the start is most of what is known.
constexpr double kLeastFraction = 0.01;

TimeLeft not_over(double seconds, const char* trust) {
    return seconds > 0 ? TimeLeft{seconds, trust} : TimeLeft{};
}

TimeLeft by_forecast(const RenderProgress& p) {
    if (p.target.trust == Trust::none) return {};
    return not_over(p.target.seconds - (p.run_seconds - p.target_since), trust_words(p.target.trust));
}

}  // namespace

TimeLeft TimeLeftClock::by_samples(const RenderProgress& p) {
    if (p.fraction > fraction_) {
        fraction_ = p.fraction;
        seconds_ = p.run_seconds;
    }
    if (fraction_ < kLeastFraction) return {};
    return not_over(seconds_ * (1 - fraction_) / fraction_ - (p.run_seconds - seconds_), "about ");
}

TimeLeft TimeLeftClock::at(const RenderProgress& p) {
    if (budget_.seconds == 0 && budget_.error == 0) return by_samples(p);
    TimeLeft left;
    if (budget_.error > 0) left = by_forecast(p);
    if (budget_.seconds > 0)
        if (const TimeLeft clock = not_over(budget_.seconds - p.run_seconds, ""); clock.seconds < left.seconds)
            left = clock;
    return left;
}

}  // namespace treefarm
