// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/launch_output.h"

#include <algorithm>

#include "common/base/text/printable.h"

namespace treefarm {

namespace {

constexpr std::size_t kLongestLine = 64 << 10;

/// Whether a line is Open MPI's about a process that was lost, or a signal that it passes on.
bool is_chatter(std::string_view line) {
    return line.find("] PMIX ERROR: ") != line.npos || line.starts_with("mpirun: Forwarding signal ");
}

}  // namespace

LaunchOutput::Lines LaunchOutput::take(std::string_view part, bool is_alive) {
    Lines lines;
    rest_ += part;
    std::size_t begin = 0;
    for (std::size_t end; (end = rest_.find('\n', begin)) != std::string::npos; begin = end + 1)
        add_line(std::string_view(rest_).substr(begin, end - begin), is_alive, lines);
    rest_.erase(0, begin);
    if (rest_.size() > kLongestLine) {
        add_line(rest_, is_alive, lines);
        rest_.clear();
    }
    return lines;
}

LaunchOutput::Lines LaunchOutput::take_rest() {
    return rest_.empty() ? Lines{} : take("\n", false);
}

void LaunchOutput::add_line(std::string_view line, bool is_alive, Lines& lines) {
    // Behind a mark, since another rank's line may have no end yet.
    if (const std::size_t mark = line.find(kLifeMark); mark != line.npos) {
        if (const auto sign = parse_life_status(std::string(line.substr(mark + 1)))) sign_ = sign;
        if (mark == 0) return;
        line = line.substr(0, mark);
    }
    std::string text(line);
    std::replace(text.begin(), text.end(), '\t', ' ');
    if (text.ends_with('\r')) text.pop_back();
    text = printable(text) + "\n";
    lines.log += text;
    if (!is_alive || !is_chatter(line)) lines.terminal += text;
}

}  // namespace treefarm
