// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <variant>

namespace treefarm {

/// Kinds of shapes, materials, emitters and textures list each of their values once, in fields(self, visitor), in
/// packed order. Packing, range checks, `treefarm check`, use of textures and images, removal of unused parts,
/// docs/generated/scene.md and seeds for the fuzzer are derived from that list. A visitor has these members, by type of
/// value, for any kind:
///
///     flag(name, bool&)
///
/// of a material:
///
///     fraction(name, ColorInput& or FloatInput&)  a factor in [0, 1], constant or textured
///     anisotropy(FloatInput&)                     a factor in [0, 1]; above 0 tangents are needed
///     number(name, FloatInput& or ColorInput&, least, most)  any other number, within these bounds
///     together(ColorInput&, ColorInput&)          two factors named before, whose sum may not be above 1
///     choice(name, Enum&, last)                   one of an enum's values, from 0 to `last`
///     eta(float&)                                 ratio of indices of refraction, above 0
///     metal(Rgb& eta, Rgb& k)                     complex index of refraction
///     roughness(Roughness&, bool isotropic)
///     part(name, std::int32_t&)                   index of a material that stands before this one
///
/// of an emitter:
///
///     light(name, Rgb&, ColorInput& or float&)    emission, or a factor on it, at least 0
///     position(Vec3&)                             in the scene
///     direction(Vec3&)                            of unit length
///     value(float&)                               any other number, checked by a rule
///     texture(std::int32_t&)                      index of a texture that light is multiplied by, or kNone
///     image(std::int32_t&)                        index of an image of three channels
///     shape(std::int32_t&)                        index of the emitting shape
///     rule(bool holds, what, cure)                a condition on values named before; fault and cure
///
/// of a shape:
///
///     point(name, Vec3&)                          a point
///     offset(name, Vec3&)                         a vector between points
///     axis(name, Vec3&)                           of unit length
///     radius(float&)                              above 0
///     rule(bool holds, what, cure)                as of an emitter; `what` continues "the shape"
///     group(std::int32_t&)                        index of the group of shapes that this one instances
///     transform(Imath::M44f&)                     affine, and can be inverted
///     vertices(std::vector<Vec3>&)                points
///     per_vertex(name, std::vector<Vec2 or Vec3>&)  one for each of the vertices, or none at all
///     triangles(std::vector<std::uint32_t>&)      three indices of vertices for each
///     attributes(std::vector<MeshAttribute>&)     values for textures at vertices or triangles
///
/// of a texture:
///
///     image(std::int32_t&)                        index of an image
///     choice(name, Enum&, last)                   as of a material
///     color(name, Rgb&)                           a finite colour
///     extent(name, float&)                        a length, 0 or more
///     coordinates(UvTransform&)                   transform of texture coordinates
///     mesh_attribute(std::string&)                name of the attribute of the mesh that it shows
///
/// Names are words for messages: "specular reflectance".

/// A visitor that ignores everything; base of visitors that handle only some values.
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
    void light(const char*, const auto&) {}
    void position(const auto&) {}
    void direction(const auto&) {}
    void value(const auto&) {}
    void texture(const auto&) {}
    void image(const auto&) {}
    void shape(const auto&) {}
    void rule(bool, const char*, const char*) {}
    void color(const char*, const auto&) {}
    void extent(const char*, const auto&) {}
    void coordinates(const auto&) {}
    void mesh_attribute(const auto&) {}
    void point(const char*, const auto&) {}
    void offset(const char*, const auto&) {}
    void axis(const char*, const auto&) {}
    void radius(const auto&) {}
    void group(const auto&) {}
    void transform(const auto&) {}
    void vertices(const auto&) {}
    void per_vertex(const char*, const auto&) {}
    void triangles(const auto&) {}
    void attributes(const auto&) {}
};

/// Visitor that calls f for each image of a kind, by a modifiable reference.
template <class F>
struct ImageVisitor : IgnoreFields {
    F& f;
    explicit ImageVisitor(F& call) : f(call) {}
    void image(auto& index) { f(index); }
};

/// Calls a visitor for each value of a variant of kinds, const or not.
template <class Kind, class Visitor>
void visit_fields(Kind& kind, Visitor&& visitor) {
    std::visit([&](auto& held) { std::decay_t<decltype(held)>::fields(held, visitor); }, kind);
}

/// Calls f.operator()<Kind>() for every kind of a variant.
template <class Variant, class F>
constexpr void for_each_kind(F&& f) {
    const auto call = [&]<class... Kinds>(std::type_identity<std::variant<Kinds...>>) {
        (f.template operator()<Kinds>(), ...);
    };
    call(std::type_identity<Variant>());
}

}  // namespace treefarm
