// SPDX-License-Identifier: Apache-2.0
#include "serve/pass_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

namespace treefarm {

namespace {

constexpr RunKey kShown[] = {
    "pass",         "spp",          "spp_done",       "workers",   "threads",    "seconds",         "run_seconds",
    "core_seconds", "idle_seconds", "error",          "error_low", "error_high", "halving_seconds", "rays_per_second",
    "guided",       "tree_regions", "invalid_samples"};
constexpr std::size_t kMostRows = 1000;

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(separator, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

FileJson number_in(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return nullptr;
    return value;
}

}  // namespace

FileJson pass_table(const std::string& csv) {
    FileJson rows = FileJson::array();
    // Text after the last line end is a line being written.
    std::vector<std::string_view> lines = split(std::string_view(csv).substr(0, csv.rfind('\n') + 1), '\n');
    if (lines.size() < 2) return rows;
    lines.pop_back();
    std::vector<std::string_view> names = split(lines.front(), ',');
    std::transform(names.begin(), names.end(), names.begin(), current_name);
    for (std::size_t k = std::max<std::size_t>(1, lines.size() > kMostRows ? lines.size() - kMostRows : 0);
         k < lines.size(); ++k) {
        const std::vector<std::string_view> fields = split(lines[k], ',');
        if (fields.size() != names.size()) continue;
        FileJson row = FileJson::object();
        for (const RunKey shown : kShown)
            if (const auto column = std::find(names.begin(), names.end(), shown.name()); column != names.end())
                row[shown.name()] = number_in(fields[static_cast<std::size_t>(column - names.begin())]);
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace treefarm
