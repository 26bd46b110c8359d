// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.h"
#include "common/scene/emitter.h"

namespace treefarm::packed {

///     emitter  := kind:u8 (area | point | spot | directional | constant | environment) location
///     area     := color shape:i32
///     point    := position intensity:rgb
///     spot     := position axis intensity:rgb cutoff:f32 beam:f32
///     directional := direction irradiance:rgb
///     constant := radiance:rgb
///     environment := image:i32 scale:f32 x_axis y_axis z_axis rows_at_poles:u8

inline constexpr std::size_t kMinEmitterBytes = 22;

void put_emitter(ByteWriter& out, const Emitter& emitter);
Emitter get_emitter(ByteReader& in, std::size_t shape_count, std::size_t texture_count, std::size_t image_count);

}  // namespace treefarm::packed
