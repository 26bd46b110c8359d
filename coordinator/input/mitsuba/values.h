// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "common/base/error.h"

namespace treefarm::mitsuba {

/// A finite number; otherwise throws InputError at `where`.
double number_of(std::string_view text, const Location& where);

/// Entries of a list, separated by commas or white space.
std::vector<std::string_view> split_list(std::string_view text);

/// Numbers of a list, separated by commas or white space.
std::vector<double> numbers_of(std::string_view text, const Location& where);

}  // namespace treefarm::mitsuba
