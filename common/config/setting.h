// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/error.h"

namespace treefarm {

/// A key with its value as text, and its location: in a job file, in the scene's integrator, or in --set.
struct Setting {
    std::string key;    ///< "integrator.max_depth"
    std::string value;  ///< as text, without quotes
    Location where;
};

}  // namespace treefarm
