// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/fields.h"
#include "common/scene/model/material.h"

namespace treefarm {

template <class F>
struct InputVisitor : IgnoreFields {
    F& f;
    explicit InputVisitor(F& call) : f(call) {}
    void fraction(const char*, auto& input) { f(input); }
    void anisotropy(auto& input) { f(input); }
    void number(const char*, auto& input, float, float) { f(input); }
    void roughness(auto& roughness, bool) {
        f(roughness.alpha_u);
        f(roughness.alpha_v);
    }
};

template <class F>
struct PartVisitor : IgnoreFields {
    F& f;
    explicit PartVisitor(F& call) : f(call) {}
    void part(const char*, auto& index) {
        if (index != kNone) f(index);
    }
};

/// Calls f(input) for each ColorInput and FloatInput of a material's BSDF, without opacity and normals. `MaterialRef`
/// is Material or const Material.
template <class MaterialRef, class F>
void for_each_input(MaterialRef& material, F&& f) {
    visit_fields(material.bsdf, InputVisitor<F>(f));
}

/// Calls f(texture index) for each texture of a material, by a modifiable reference.
template <class MaterialRef, class F>
void for_each_texture(MaterialRef& material, F&& f) {
    const auto visit = [&](auto& index) {
        if (index != kNone) f(index);
    };
    for_each_input(material, [&](auto& input) { visit(input.texture); });
    visit(material.opacity.texture);
    visit(material.detail.bump);
    visit(material.detail.normal_map);
}

/// Calls f(material index) for each material that a material consists of (parts, and a back of its own), by a
/// modifiable reference.
template <class MaterialRef, class F>
void for_each_part(MaterialRef& material, F&& f) {
    visit_fields(material.bsdf, PartVisitor<F>(f));
    if (material.twosided && material.back != kNone) f(material.back);
}

}  // namespace treefarm
