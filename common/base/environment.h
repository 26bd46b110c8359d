// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>

namespace treefarm {

/// Whether an environment variable is there and not empty: NAME= is how a shell or a queue's script takes one back.
inline bool is_set(const char* name) {
    const char* const text = std::getenv(name);
    return text && *text;
}

/// The whole number that an environment variable begins with; 0 where it is not there, or no number.
inline int number_in(const char* name) {
    const char* const text = std::getenv(name);
    return text ? std::atoi(text) : 0;
}

}  // namespace treefarm
