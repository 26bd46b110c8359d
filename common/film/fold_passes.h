// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/film/combine.h"

namespace treefarm {

/// Greatest number of pass images that a render keeps, which bounds its memory.
inline constexpr std::size_t kMostPassImages = 8;

/// Index of the first of the two neighbours to merge. Pairs of alike passes come first, since merging them loses
/// nothing; then pairs of one technique, then any; among equals the pair with the fewest samples, then the oldest. The
/// last pass is never merged, since its own figures are needed. The choice does not depend on samples, so it cannot
/// bias the image. `passes`: at least three.
std::size_t pair_to_fold(std::span<const PassResult> passes);

/// Merges two neighbours if there are more than kMostPassImages: their samples become those of one pass
/// (docs/design/error.md, "many passes"). To be called after each pass.
void fold_passes(std::vector<PassResult>& passes);

}  // namespace treefarm
