// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace treefarm {

/// Method of combining the images of passes (docs/design/error.md, "combining passes").
enum class Combination : std::uint8_t {
    inverse_variance,  ///< one scalar weight per pass, cross-fitted over two halves
    fixed,             ///< weights set in advance: exactly unbiased, as z-tests need
    last,              ///< only the passes with the last tree (PPG 2017)
};

}  // namespace treefarm
