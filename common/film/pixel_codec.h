// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/base/bytes.h"
#include "common/film/pixel_estimate.h"

namespace treefarm {

/// Bytes of a stored estimate: for each half its count, mean and squared deviations.
inline constexpr std::size_t kEstimateBytes = 2 * (sizeof(std::uint32_t) + 6 * sizeof(double));

void put_estimate(ByteWriter& writer, const PixelEstimate& pixel);
/// Throws FormatError where too few bytes remain.
PixelEstimate get_estimate(ByteReader& reader);

}  // namespace treefarm
