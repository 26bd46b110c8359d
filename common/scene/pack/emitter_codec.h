// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.h"
#include "common/scene/model/emitter.h"
#include "common/scene/pack/packed_fields.h"

namespace treefarm::packed {

///     emitter  := kind:u8 value*
///
/// kind: index in EmitterKind (kinds/emitters.h); values: in the order of the kind's fields(), vectors and colours as
/// three f32, a color as rgb texture:i32, indices as i32, flags as u8.

inline constexpr std::size_t kMinEmitterBytes = 13;

void put_emitter(ByteWriter& out, const Emitter& emitter);
Emitter get_emitter(ByteReader& in, const PackedCounts& counts);

}  // namespace treefarm::packed
