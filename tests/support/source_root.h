// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace treefarm::test {

/// Root of the source tree that the tests were built from.
inline const std::filesystem::path kRoot = TREEFARM_SOURCE_DIR;

}  // namespace treefarm::test
