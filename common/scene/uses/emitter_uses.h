// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>

#include "common/scene/model/emitter.h"

namespace treefarm {

template <class F>
struct EmitterTextureVisitor : IgnoreFields {
    F& f;
    explicit EmitterTextureVisitor(F& call) : f(call) {}
    void light(const char*, auto& value) {
        if constexpr (requires { value.texture; }) texture(value.texture);
    }
    void texture(auto& index) {
        if (index != kNone) f(index);
    }
};

template <class EmitterRef>
concept IsEmitter = std::same_as<std::remove_const_t<EmitterRef>, Emitter>;

/// Calls f(texture index) for each texture of an emitter, by a modifiable reference.
template <IsEmitter EmitterRef, class F>
void for_each_texture(EmitterRef& emitter, F&& f) {
    visit_fields(emitter.kind, EmitterTextureVisitor<F>(f));
}

/// Calls f(image index) for each image of an emitter, by a modifiable reference.
template <IsEmitter EmitterRef, class F>
void for_each_image(EmitterRef& emitter, F&& f) {
    visit_fields(emitter.kind, ImageVisitor<F>(f));
}

/// Whether a texture modulates the light of an emitter.
inline bool is_textured(const Emitter& emitter) {
    bool found = false;
    for_each_texture(emitter, [&](std::int32_t) { found = true; });
    return found;
}

/// Index of the shape that emits, or kNone.
inline std::int32_t shape_of(const Emitter& emitter) {
    struct : IgnoreFields {
        std::int32_t found = kNone;
        void shape(std::int32_t index) { found = index; }
    } visitor;
    visit_fields(emitter.kind, visitor);
    return visitor.found;
}

/// Cone of light of a point emitter; empty for other kinds.
inline std::optional<LightCone> cone_of(const Emitter& emitter) {
    return std::visit(
        [](const auto& kind) -> std::optional<LightCone> {
            if constexpr (std::decay_t<decltype(kind)>::kTraits.type == LightType::delta)
                return kind.cone();
            else
                return std::nullopt;
        },
        emitter.kind);
}

}  // namespace treefarm
