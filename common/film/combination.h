// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace treefarm {

/// How the images of the passes become one (docs/design/error.md, "combining passes").
enum class Combination : std::uint8_t {
    inverse_variance,  ///< one scalar per pass, cross-fitted over two halves
    fixed,             ///< weights set beforehand: exactly unbiased, what z-tests use
    last,              ///< the passes of the last tree alone (PPG 2017)
};

}  // namespace treefarm
