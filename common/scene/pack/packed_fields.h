// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <variant>

#include "common/scene/kinds/fields.h"
#include "common/scene/kinds/materials/roughness.h"
#include "common/scene/kinds/shapes/mesh.h"
#include "common/scene/kinds/traits/texture_traits.h"
#include "common/scene/pack/packed_values.h"

namespace treefarm::packed {

/// Visitor that packs the values of a kind (kinds/fields.h).
class PutFields {
  public:
    explicit PutFields(ByteWriter& out) : out_(out) {}

    void fraction(const char*, const ColorInput& input) { put_color(out_, input); }
    void fraction(const char*, const FloatInput& input) { put_number(out_, input); }
    void anisotropy(const FloatInput& input) { put_number(out_, input); }
    void number(const char*, const FloatInput& input, float, float) { put_number(out_, input); }
    void number(const char*, const ColorInput& input, float, float) { put_color(out_, input); }
    void together(const ColorInput&, const ColorInput&) {}
    void choice(const char*, auto value, auto) { put_enum(out_, value); }
    void eta(float value) { out_.put(value); }
    void metal(const Rgb& eta, const Rgb& k) {
        put_vector(out_, eta);
        put_vector(out_, k);
    }
    void roughness(const Roughness& roughness, bool) {
        put_enum(out_, roughness.distribution);
        put_number(out_, roughness.alpha_u);
        put_number(out_, roughness.alpha_v);
    }
    void flag(const char*, bool value) { put_flag(out_, value); }
    void part(const char*, std::int32_t index) { out_.put(index); }

    void light(const char*, const Rgb& value) { put_vector(out_, value); }
    void light(const char*, const ColorInput& value) { put_color(out_, value); }
    void light(const char*, float value) { out_.put(value); }
    void position(const Vec3& value) { put_vector(out_, value); }
    void direction(const Vec3& value) { put_vector(out_, value); }
    void value(float value) { out_.put(value); }
    void texture(std::int32_t index) { out_.put(index); }
    void image(std::int32_t index) { out_.put(index); }
    void shape(std::int32_t index) { out_.put(index); }
    void rule(bool, const char*, const char*) {}

    void color(const char*, const Rgb& value) { put_vector(out_, value); }
    void mesh_attribute(const std::string& name) { out_.put_string(name); }
    void extent(const char*, float value) { out_.put(value); }
    void coordinates(const UvTransform& uv) {
        put_vector(out_, uv.u_row);
        put_vector(out_, uv.v_row);
    }

    void point(const char*, const Vec3& value) { put_vector(out_, value); }
    void offset(const char*, const Vec3& value) { put_vector(out_, value); }
    void axis(const char*, const Vec3& value) { put_vector(out_, value); }
    void radius(float value) { out_.put(value); }
    void group(std::int32_t index) { out_.put(index); }
    void transform(const Imath::M44f& m) {
        if (m[0][3] != 0.0f || m[1][3] != 0.0f || m[2][3] != 0.0f || m[3][3] != 1.0f)
            throw FormatError("scene: a transform is not affine: it has no packed form");
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 3; ++column)
                out_.put(m[row][column]);
    }
    void vertices(const std::vector<Vec3>& positions) { put_vectors(out_, positions); }
    void per_vertex(const char*, const auto& values) { put_vectors(out_, values); }
    void triangles(const std::vector<std::uint32_t>& indices) {
        out_.put_array(std::span<const std::uint32_t>(indices));
    }
    void attributes(const std::vector<MeshAttribute>& attributes) {
        if (attributes.empty()) return;
        put_list(out_, attributes, [](ByteWriter& to, const MeshAttribute& attribute) {
            to.put_string(attribute.name);
            put_vectors(to, attribute.values);
        });
    }

  private:
    ByteWriter& out_;
};

/// Numbers of the elements that indices may refer to.
struct PackedCounts {
    std::size_t parts = 0;  ///< materials before the one being read
    std::size_t textures = 0, images = 0, shapes = 0, groups = 0;
    bool with_attributes = false;  ///< the mesh being read has attributes
};

/// Visitor that unpacks the values of a kind. Indices are checked against PackedCounts, so readers of a scene need no
/// checks.
class GetFields {
  public:
    GetFields(ByteReader& in, const PackedCounts& counts) : in_(in), counts_(counts) {}

    void fraction(const char*, ColorInput& input) { input = get_color(in_, counts_.textures); }
    void fraction(const char*, FloatInput& input) { input = get_number(in_, counts_.textures); }
    void anisotropy(FloatInput& input) { input = get_number(in_, counts_.textures); }
    void number(const char*, FloatInput& input, float, float) { input = get_number(in_, counts_.textures); }
    void number(const char*, ColorInput& input, float, float) { input = get_color(in_, counts_.textures); }
    void together(const ColorInput&, const ColorInput&) {}
    void choice(const char* name, auto& value, auto last) { value = get_enum(in_, last, name); }
    void eta(float& value) { value = in_.get<float>(); }
    void metal(Rgb& eta, Rgb& k) {
        eta = get_vector<Rgb>(in_);
        k = get_vector<Rgb>(in_);
    }
    void roughness(Roughness& roughness, bool) {
        roughness.distribution = get_enum(in_, Microfacets::beckmann, "microfacet distribution");
        roughness.alpha_u = get_number(in_, counts_.textures);
        roughness.alpha_v = get_number(in_, counts_.textures);
    }
    void flag(const char* name, bool& value) { value = get_flag(in_, name); }
    void part(const char* name, std::int32_t& index) { index = get_index(in_, counts_.parts, name); }

    void light(const char*, Rgb& value) { value = get_vector<Rgb>(in_); }
    void light(const char*, ColorInput& value) { value = get_color(in_, counts_.textures); }
    void light(const char*, float& value) { value = in_.get<float>(); }
    void position(Vec3& value) { value = get_vector<Vec3>(in_); }
    void direction(Vec3& value) { value = get_vector<Vec3>(in_); }
    void value(float& value) { value = in_.get<float>(); }
    void texture(std::int32_t& index) { index = get_optional_index(in_, counts_.textures, "texture of an emitter"); }
    void image(std::int32_t& index) { index = get_index(in_, counts_.images, "image"); }
    void shape(std::int32_t& index) { index = get_index(in_, counts_.shapes, "emitting shape"); }
    void rule(bool, const char*, const char*) {}

    void color(const char*, Rgb& value) { value = get_vector<Rgb>(in_); }
    void mesh_attribute(std::string& name) { name = in_.get_string(); }
    void extent(const char*, float& value) { value = in_.get<float>(); }
    void coordinates(UvTransform& uv) {
        uv.u_row = get_vector<Vec3>(in_);
        uv.v_row = get_vector<Vec3>(in_);
    }

    void point(const char*, Vec3& value) { value = get_vector<Vec3>(in_); }
    void offset(const char*, Vec3& value) { value = get_vector<Vec3>(in_); }
    void axis(const char*, Vec3& value) { value = get_vector<Vec3>(in_); }
    void radius(float& value) { value = in_.get<float>(); }
    void group(std::int32_t& index) { index = get_index(in_, counts_.groups, "group"); }
    void transform(Imath::M44f& m) {
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 3; ++column)
                m[row][column] = in_.get<float>();
    }
    void vertices(std::vector<Vec3>& positions) {
        positions = get_vectors<Vec3>(in_);
        vertices_ = positions.size();
    }
    template <class V>
    void per_vertex(const char* name, std::vector<V>& values) {
        values = get_vectors<V>(in_);
        if (!values.empty()) expect_count(values.size(), vertices_, name);
    }
    void triangles(std::vector<std::uint32_t>& indices) {
        indices = in_.get_array<std::uint32_t>();
        if (indices.size() % 3 != 0) throw FormatError("scene: a mesh's indices are no whole triangles");
        for (const std::uint32_t index : indices)
            if (index >= vertices_)
                throw FormatError("scene: vertex " + std::to_string(index) + " of " + std::to_string(vertices_));
        triangles_ = indices.size() / 3;
    }
    void attributes(std::vector<MeshAttribute>& attributes) {
        if (!counts_.with_attributes) return;
        get_list(in_, kMinAttributeBytes, attributes, [&] {
            MeshAttribute attribute;
            attribute.name = in_.get_string();
            attribute.values = get_vectors<Rgb>(in_);
            expect_count(attribute.values.size(), attribute.is_of_faces() ? triangles_ : vertices_, "attribute value");
            return attribute;
        });
        if (attributes.empty()) throw FormatError("scene: a mesh has attributes, and none");
    }

  private:
    static constexpr std::size_t kMinAttributeBytes = 2;

    static void expect_count(std::size_t found, std::size_t wanted, const char* of_what) {
        if (found != wanted)
            throw FormatError("scene: a mesh has " + std::to_string(found) + " " + of_what + "s, not " +
                              std::to_string(wanted));
    }

    ByteReader& in_;
    PackedCounts counts_;
    std::size_t vertices_ = 0, triangles_ = 0;  ///< of the mesh being read
};

/// Default value of a variant's alternative with this number. Throws FormatError such as "unknown kind of material 99"
/// if there is none.
template <class Variant>
Variant kind_of(std::size_t number, const char* what) {
    Variant kind;
    const auto make = [&]<std::size_t... kNumber>(std::index_sequence<kNumber...>) {
        return ((number == kNumber && (kind.template emplace<kNumber>(), true)) || ...);
    };
    if (!make(std::make_index_sequence<std::variant_size_v<Variant>>()))
        throw FormatError("scene: unknown kind of " + std::string(what) + " " + std::to_string(number));
    return kind;
}

}  // namespace treefarm::packed
