// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Version of the Embree library that this process has loaded: "3.13.5".
std::string embree_version();

}  // namespace treefarm
