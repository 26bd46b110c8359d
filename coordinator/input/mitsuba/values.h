// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "common/base/error.h"

namespace treefarm::mitsuba {

/// A finite number, or InputError at `where`.
double number_of(std::string_view text, const Location& where);

/// The parts of a list, separated by commas or white space.
std::vector<std::string_view> split_list(std::string_view text);

/// All numbers of a list, separated by commas or white space.
std::vector<double> numbers_of(std::string_view text, const Location& where);

}  // namespace treefarm::mitsuba
