// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/base/bytes.h"
#include "common/film/pixel_estimate.h"

namespace treefarm {

/// Bytes of a stored estimate: count, mean and squared deviations of each half.
inline constexpr std::size_t kEstimateBytes = 2 * (sizeof(std::uint32_t) + 6 * sizeof(double));

void put_estimate(ByteWriter& writer, const PixelEstimate& pixel);
/// The next estimate; throws FormatError if too few bytes remain.
PixelEstimate get_estimate(ByteReader& reader);

}  // namespace treefarm
