// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/error.h"

namespace treefarm {

/// A problem of the input that does not prevent a render.
struct Warning {
    Location where;
    std::string what;

    /// One line: "file:line:col: what".
    std::string text() const {
        const std::string location = where.text();
        return location.empty() ? what : location + ": " + what;
    }
};

}  // namespace treefarm
