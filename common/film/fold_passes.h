// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/film/combine.h"

namespace treefarm {

/// Most images of finished passes that a render keeps, so that its memory does not grow with its passes.
inline constexpr std::size_t kMostPassImages = 8;

/// Number of the first of the two neighbours that are to become one. Alike passes come first: nothing is lost by
/// merging them. Then those of one technique, then any; of equals the two with the fewest samples together, the older
/// ones of those. The last pass stays as it is, since its own figures are still asked for. Never looks at a sample, so
/// the choice cannot bias the image. `passes`: three at least.
std::size_t pair_to_fold(std::span<const PassResult> passes);

/// Merges two neighbours of `passes` where there are more than kMostPassImages: their samples become those of one pass
/// (docs/design/error.md, "many passes"). Called after each pass.
void fold_passes(std::vector<PassResult>& passes);

}  // namespace treefarm
