// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Kinds of materials name each of their values once, in fields(self, visitor), in the order in which they are packed.
/// Packing, range checks, `treefarm check`, texture use and removal of what is unused follow from that. A
/// visitor has, for what a value is:
///
///     fraction(name, ColorInput& or FloatInput&)  a factor in [0, 1], constant or textured
///     anisotropy(FloatInput&)                     a factor in [0, 1]; above 0 tangents are needed
///     number(name, FloatInput& or ColorInput&, least, most)  any other number, within these bounds
///     together(ColorInput&, ColorInput&)          two factors named before, whose sum may not be above 1
///     choice(name, Enum&, last)                   one of an enum's values, from 0 to `last`
///     eta(float&)                                 ratio of indices of refraction, above 0
///     metal(Rgb& eta, Rgb& k)                     complex index of refraction
///     roughness(Roughness&, bool isotropic)
///     flag(name, bool&)
///     part(name, std::int32_t&)                   index of a material that stands before this one
///
/// Names are words for messages: "specular reflectance".

/// A visitor that looks at nothing: others derive from it and hide what they care for.
struct IgnoreFields {
    void fraction(const char*, const auto&) {}
    void anisotropy(const auto&) {}
    void number(const char*, const auto&, float, float) {}
    void together(const auto&, const auto&) {}
    void choice(const char*, const auto&, auto) {}
    void eta(const float&) {}
    void metal(const auto&, const auto&) {}
    void roughness(const auto&, bool) {}
    void flag(const char*, const bool&) {}
    void part(const char*, const auto&) {}
};

}  // namespace treefarm
