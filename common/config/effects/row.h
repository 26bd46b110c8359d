// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

namespace treefarm {

/// Words of an effect, for people: a row of docs/generated/effects.md.
struct EffectText {
    const char* name;   ///< "bump": unique, as jobs and plans write it
    const char* group;  ///< "materials"
    const char* what;   ///< one line
    const char* when;   ///< when it is on; a `*` stands for the names of the effects that are part of it
    const char* cost;   ///< in memory and in time
};

/// Where a family of kinds (common/scene/kinds) names its effects.
enum class EffectFamily { none, emitters, materials, textures };

/// What `effects.NAME = false` in a job does.
template <class Remove>
struct OffSwitch {
    int step;  ///< 1, 2, ...: its place in job.toml, and when it is taken out: of textures the mean first
    const char* replacement;  ///< what the image shows in its place
    Remove remove;  ///< takes it out of a scene: called with a Remover (common/plan/effects/approximation.cpp)
};

/// What to do instead of switching off an effect that no key switches off.
struct NoSwitch {
    const char* cure;
};

/// An effect that goes off with another one, which has a switch.
struct PartOf {
    const char* whole;
};

/// An effect: its words, what finds it in a scene and a job, and how it is switched off.
template <class Find, class Off>
struct EffectRow {
    EffectText text;
    EffectFamily family;
    Find find;  ///< called with an EffectFinder (common/plan/effects/effect_finder.h), whose members say what there is
                ///< to ask
    Off off;
};

template <class Off>
inline constexpr bool kHasSwitch = !std::is_same_v<Off, NoSwitch> && !std::is_same_v<Off, PartOf>;

template <class Remove>
constexpr OffSwitch<Remove> replaced(int step, const char* replacement, Remove remove) {
    return {step, replacement, remove};
}

constexpr NoSwitch instead(const char* cure) {
    return {cure};
}

constexpr PartOf part_of(const char* whole) {
    return {whole};
}

template <class Find, class Off>
constexpr EffectRow<Find, Off> effect(const EffectText& text, Find find, Off off) {
    return {text, EffectFamily::none, find, off};
}

/// Finds the kinds of a family that name an effect as theirs.
struct FindKind {
    const char* name;
    EffectFamily family;
    constexpr auto operator()(const auto& find) const { return find.kind(family, name); }
};

/// An effect that is on where there is an emitter, a material or a texture of a kind that names it.
template <class Off>
constexpr EffectRow<FindKind, Off> effect_of_kind(const EffectText& text, EffectFamily family, Off off) {
    return {text, family, {text.name, family}, off};
}

}  // namespace treefarm
