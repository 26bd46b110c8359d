// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

namespace treefarm {

/// Texts about an effect: a row of docs/generated/effects.md.
struct EffectText {
    const char* name;   ///< "bump": unique; used in jobs and plans
    const char* group;  ///< "materials"
    const char* what;   ///< one line
    const char*
        when;  ///< condition under which it is on; a `*` stands for the names of the effects that are part of it
    const char* cost;  ///< cost in memory and in time
};

/// Family of kinds (common/scene/kinds) that declares effects.
enum class EffectFamily { none, emitters, materials, textures };

/// Action of `effects.NAME = false` in a job.
template <class Remove>
struct OffSwitch {
    int step;  ///< 1, 2, ...: position in job.toml and order of removal: the mean of textures is taken first
    const char* replacement;  ///< what the image shows in its place
    Remove remove;  ///< removes it from a scene: called with a Remover (common/plan/effects/approximation.cpp)
};

/// Advice for an effect without a switch.
struct NoSwitch {
    const char* cure;
};

/// Marks an effect that is switched off together with another one.
struct PartOf {
    const char* whole;
};

/// An effect: its texts, its finder in a scene and a job, and its switch.
template <class Find, class Off>
struct EffectRow {
    EffectText text;
    EffectFamily family;
    Find find;  ///< called with an EffectFinder (common/plan/effects/effect_finder.h)
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

/// Finder of the kinds of a family that declare the effect as their own.
struct FindKind {
    const char* name;
    EffectFamily family;
    constexpr auto operator()(const auto& find) const { return find.kind(family, name); }
};

/// Row of an effect that is on if an emitter, a material or a texture has a kind that declares it.
template <class Off>
constexpr EffectRow<FindKind, Off> effect_of_kind(const EffectText& text, EffectFamily family, Off off) {
    return {text, family, {text.name, family}, off};
}

}  // namespace treefarm
