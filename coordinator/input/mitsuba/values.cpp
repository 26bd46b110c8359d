// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/values.h"

#include "common/base/text/parse_text.h"

namespace treefarm::mitsuba {

double number_of(std::string_view text, const Location& where) {
    if (const auto number = parse_number(text)) return *number;
    throw InputError(where, in_quotes(text) + " is not a number", "write a finite decimal number");
}

std::vector<std::string_view> split_list(std::string_view text) {
    constexpr std::string_view separators = ", \t\r\n";
    std::vector<std::string_view> parts;
    for (std::size_t at = text.find_first_not_of(separators); at != std::string_view::npos;
         at = text.find_first_not_of(separators, at)) {
        const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
        parts.push_back(text.substr(at, end - at));
        at = end;
    }
    return parts;
}

std::vector<double> numbers_of(std::string_view text, const Location& where) {
    std::vector<double> numbers;
    for (const std::string_view part : split_list(text))
        numbers.push_back(number_of(part, where));
    return numbers;
}

}  // namespace treefarm::mitsuba
