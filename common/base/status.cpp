// SPDX-License-Identifier: Apache-2.0
#include "common/base/status.h"

#include <algorithm>
#include <cmath>

#include "common/base/terminal.h"
#include "common/base/text/printable.h"

namespace treefarm {

namespace {

constexpr int kLongestBar = 30, kUsualBar = 10, kShortestBar = 4;  ///< columns, without its ends
constexpr int kBarFrame = 4;                                       ///< columns of its ends and of the space after it

std::string bar(double fraction, int width) {
    const int filled = std::clamp(static_cast<int>(std::lround(fraction * width)), 0, width);
    return "[" + std::string(static_cast<std::size_t>(filled), '=') +
           std::string(static_cast<std::size_t>(width - filled), ' ') + "]  ";
}

}  // namespace

std::string join_fields(const std::vector<std::string>& fields) {
    std::string text;
    for (const std::string& field : fields)
        if (!field.empty()) text += (text.empty() ? "" : "   ") + field;
    return text;
}

std::string status_text(const Status& status, int columns) {
    std::vector<std::string> fields;
    for (const std::string& field : status.fields)
        if (!field.empty()) fields.push_back(printable(field));
    const auto free_columns = [&] { return columns - text_columns(join_fields(fields)); };
    const bool has_bar = status.fraction >= 0;
    while (fields.size() > status.essential && free_columns() < (has_bar ? kUsualBar + kBarFrame : 0))
        fields.pop_back();
    while (fields.size() > 1 && free_columns() < 0)
        fields.pop_back();
    const std::string text = cut_to_columns(join_fields(fields), columns);
    const int width = std::min(free_columns() - kBarFrame, kLongestBar);
    return has_bar && width >= kShortestBar ? bar(status.fraction, width) + text : text;
}

}  // namespace treefarm
