// SPDX-License-Identifier: Apache-2.0
#include "common/scene/pack/material_codec.h"

#include "common/scene/pack/packed_fields.h"

namespace treefarm::packed {
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
}

Material get_material(ByteReader& in, std::size_t index, std::size_t texture_count) {
    Material material;
    material.bsdf = kind_of<MaterialKind>(in.get<std::uint8_t>(), "material");
    visit_fields(material.bsdf, GetFields(in, {.parts = index, .textures = texture_count}));
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
    return material;
}

}  // namespace treefarm::packed
