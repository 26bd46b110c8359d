// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>

namespace treefarm {

/// Whether an environment variable is set and not empty: shells and queue scripts unset one by NAME=.
inline bool is_set(const char* name) {
    const char* const text = std::getenv(name);
    return text && *text;
}

/// Whole number at the start of an environment variable; 0 if it is unset, or no number.
inline int number_in(const char* name) {
    const char* const text = std::getenv(name);
    return text ? std::atoi(text) : 0;
}

}  // namespace treefarm
