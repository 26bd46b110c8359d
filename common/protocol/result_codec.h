// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/protocol/messages.h"

namespace treefarm {

/// Bytes of an encoded unit: kind:u8, then of a tile x0 y0 x1 y1:u16 chunk:u32, of light paths first:u64 count:u32, of
/// chains first:u32 count:u32; the pass is written once per message.
inline constexpr std::size_t kLeastUnitBytes = 9, kMostUnitBytes = 13;

/// Bytes of an encoded pixel: mean and squared deviations of both halves; the number of samples is written once per
/// unit.
inline constexpr std::size_t kPixelBytes = 12 * sizeof(double);

void write_unit(ByteWriter& writer, const WorkUnit& unit);
WorkUnit read_unit(ByteReader& reader, std::uint32_t pass);

void write_result(ByteWriter& writer, const Result& result);
Result read_result(ByteReader& reader);

}  // namespace treefarm
