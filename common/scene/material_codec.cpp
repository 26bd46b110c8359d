// SPDX-License-Identifier: Apache-2.0
#include "common/scene/material_codec.h"

#include "common/scene/packed_values.h"

namespace treefarm::packed {
namespace {

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

  private:
    ByteWriter& out_;
};

/// Indices are held against what there is: no reader of a scene need look again.
class GetFields {
  public:
    GetFields(ByteReader& in, std::size_t index, std::size_t texture_count)
        : in_(in), index_(index), texture_count_(texture_count) {}

    void fraction(const char*, ColorInput& input) { input = get_color(in_, texture_count_); }
    void fraction(const char*, FloatInput& input) { input = get_number(in_, texture_count_); }
    void anisotropy(FloatInput& input) { input = get_number(in_, texture_count_); }
    void number(const char*, FloatInput& input, float, float) { input = get_number(in_, texture_count_); }
    void number(const char*, ColorInput& input, float, float) { input = get_color(in_, texture_count_); }
    void together(const ColorInput&, const ColorInput&) {}
    void choice(const char* name, auto& value, auto last) { value = get_enum(in_, last, name); }
    void eta(float& value) { value = in_.get<float>(); }
    void metal(Rgb& eta, Rgb& k) {
        eta = get_vector<Rgb>(in_);
        k = get_vector<Rgb>(in_);
    }
    void roughness(Roughness& roughness, bool) {
        roughness.distribution = get_enum(in_, Microfacets::beckmann, "microfacet distribution");
        roughness.alpha_u = get_number(in_, texture_count_);
        roughness.alpha_v = get_number(in_, texture_count_);
    }
    void flag(const char* name, bool& value) { value = get_flag(in_, name); }
    void part(const char* name, std::int32_t& index) { index = get_index(in_, index_, name); }

  private:
    ByteReader& in_;
    std::size_t index_, texture_count_;
};

/// The kind of this number, as it is by default.
template <std::size_t... kNumber>
MaterialKind kind_of(std::size_t number, std::index_sequence<kNumber...>) {
    MaterialKind kind;
    if (!((number == kNumber && (kind.emplace<kNumber>(), true)) || ...))
        throw FormatError("scene: unknown kind of material " + std::to_string(number));
    return kind;
}

}  // namespace

void put_material(ByteWriter& out, const Material& material) {
    out.put(static_cast<std::uint8_t>(material.bsdf.index()));
    visit_fields(material.bsdf, PutFields(out));
    put_flag(out, material.twosided);
    out.put(material.back);
    put_flag(out, material.unlimited);
    put_number(out, material.opacity);
    out.put(material.detail.bump);
    out.put(material.detail.bump_scale);
    out.put(material.detail.normal_map);
    put_vector(out, material.detail.normal_scale);
    put_flag(out, material.detail.flip_invalid);
    put_flag(out, material.detail.shadowed);
    out.put_string(material.name);
    put_location(out, material.where);
}

Material get_material(ByteReader& in, std::size_t index, std::size_t texture_count) {
    Material material;
    material.bsdf = kind_of(in.get<std::uint8_t>(), std::make_index_sequence<std::variant_size_v<MaterialKind>>());
    visit_fields(material.bsdf, GetFields(in, index, texture_count));
    material.twosided = get_flag(in, "twosided");
    material.back = get_optional_index(in, index, "material of the back");
    if (material.back != kNone && !material.twosided)
        throw FormatError("scene: a material that is not twosided has another one for its back");
    material.unlimited = get_flag(in, "unlimited");
    material.opacity = get_number(in, texture_count);
    material.detail.bump = get_optional_index(in, texture_count, "bump texture");
    material.detail.bump_scale = in.get<float>();
    material.detail.normal_map = get_optional_index(in, texture_count, "normal map");
    material.detail.normal_scale = get_vector<Rgb>(in);
    material.detail.flip_invalid = get_flag(in, "flip_invalid");
    material.detail.shadowed = get_flag(in, "shadowed");
    material.name = in.get_string();
    material.where = get_location(in);
    return material;
}

}  // namespace treefarm::packed
