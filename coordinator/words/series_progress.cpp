// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/series_progress.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "common/base/text/duration_text.h"

namespace treefarm {

void SeriesProgress::begin(const std::string& name) {
    ++number_;
    name_ = name;
}

void SeriesProgress::end(double seconds) {
    ++rendered_;
    rendered_seconds_ += seconds;
}

std::string SeriesProgress::position() const {
    return fmt::format("{} {}/{}", noun_, number_, count_);
}

std::string SeriesProgress::left(double seconds) const {
    if (rendered_ == 0) return "";
    const double of_one = rendered_seconds_ / static_cast<double>(rendered_);
    const double of_others = of_one * static_cast<double>(count_ - number_);
    return "about " + rough_duration_text(of_others + std::max(0.0, of_one - seconds)) + " left";
}

Status SeriesProgress::status(const RenderWords& w) const {
    Status status;
    const double before = static_cast<double>(number_) - 1;
    status.fraction = (before + std::clamp(w.fraction, 0.0, 1.0)) / static_cast<double>(count_);
    status.fields = {position(), left(w.run_seconds), name_, w.how_far, w.pass};
    status.line = join_fields({position(), name_, w.pass, w.how_far, w.since_begin, left(w.run_seconds)});
    return status;
}

Status auxiliary_status(const std::string& name, const RenderWords& w) {
    Status status;
    status.fraction = w.fraction;
    status.fields = {name, w.left, w.how_far, w.pass, w.error};
    status.line = join_fields({name, w.pass, w.how_far, w.since_begin, w.left});
    return status;
}

}  // namespace treefarm
