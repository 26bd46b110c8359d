// SPDX-License-Identifier: Apache-2.0
#include "common/scene/pack/emitter_codec.h"

namespace treefarm::packed {

void put_emitter(ByteWriter& out, const Emitter& emitter) {
    out.put(static_cast<std::uint8_t>(emitter.kind.index()));
    visit_fields(emitter.kind, PutFields(out));
}

Emitter get_emitter(ByteReader& in, const PackedCounts& counts) {
    Emitter emitter;
    emitter.kind = kind_of<EmitterKind>(in.get<std::uint8_t>(), "emitter");
    visit_fields(emitter.kind, GetFields(in, counts));
    return emitter;
}

}  // namespace treefarm::packed
