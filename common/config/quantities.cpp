// SPDX-License-Identifier: Apache-2.0
#include "common/config/quantities.h"

#include <array>
#include <utility>

#include "common/base/text/parse_text.h"

namespace treefarm {

std::optional<double> parse_duration(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, double>, 4> units = {
        {{"min", 60.0}, {"m", 60.0}, {"s", 1.0}, {"h", 3600.0}}};
    text = trim(text);
    for (const auto& [unit, seconds] : units)
        if (text.ends_with(unit)) {
            const auto number = parse_number(text.substr(0, text.size() - unit.size()));
            return number ? std::optional(*number * seconds) : std::nullopt;
        }
    return parse_number(text);
}

std::optional<double> parse_fraction(std::string_view text) {
    text = trim(text);
    if (!text.ends_with('%')) return parse_number(text);
    const auto percent = parse_number(text.substr(0, text.size() - 1));
    return percent ? std::optional(*percent / 100) : std::nullopt;
}

}  // namespace treefarm
