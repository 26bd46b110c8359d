#include "common/scene/material_codec.h"

#include "common/scene/packed_values.h"

namespace treefarm::packed {
namespace {

/// The place of a kind of material in the variant is its number in packed form.
using Bsdf = decltype(Material::bsdf);
static_assert(std::is_same_v<std::variant_alternative_t<0, Bsdf>, DiffuseMaterial>);
static_assert(std::is_same_v<std::variant_alternative_t<1, Bsdf>, ConductorMaterial>);
static_assert(std::is_same_v<std::variant_alternative_t<2, Bsdf>, DielectricMaterial>);
static_assert(std::is_same_v<std::variant_alternative_t<3, Bsdf>, ThinDielectricMaterial>);
static_assert(std::is_same_v<std::variant_alternative_t<4, Bsdf>, PlasticMaterial>);
static_assert(std::is_same_v<std::variant_alternative_t<5, Bsdf>, BlendMaterial>);
static_assert(std::is_same_v<std::variant_alternative_t<6, Bsdf>, NullMaterial>);
static_assert(std::variant_size_v<Bsdf> == 7);

void put_roughness(ByteWriter& out, const Roughness& roughness) {
    put_enum(out, roughness.distribution);
    put_number(out, roughness.alpha_u);
    put_number(out, roughness.alpha_v);
}

struct Put {
    ByteWriter& out;

    void operator()(const DiffuseMaterial& m) const { put_color(out, m.reflectance); }
    void operator()(const ConductorMaterial& m) const {
        put_vector(out, m.eta);
        put_vector(out, m.k);
        put_color(out, m.specular_reflectance);
        put_roughness(out, m.roughness);
    }
    void operator()(const DielectricMaterial& m) const {
        out.put(m.eta);
        put_color(out, m.specular_reflectance);
        put_color(out, m.specular_transmittance);
        put_roughness(out, m.roughness);
    }
    void operator()(const ThinDielectricMaterial& m) const {
        out.put(m.eta);
        put_color(out, m.specular_reflectance);
        put_color(out, m.specular_transmittance);
    }
    void operator()(const PlasticMaterial& m) const {
        out.put(m.eta);
        put_color(out, m.diffuse_reflectance);
        put_color(out, m.specular_reflectance);
        put_flag(out, m.nonlinear);
        put_roughness(out, m.roughness);
        put_flag(out, m.single_return);
    }
    void operator()(const BlendMaterial& m) const {
        put_number(out, m.weight);
        out.put(m.first);
        out.put(m.second);
    }
    void operator()(const NullMaterial&) const {}
};

/// Reads the parts of materials, in their order.
class MaterialReader {
  public:
    MaterialReader(ByteReader& in, std::size_t index, std::size_t texture_count)
        : in_(in), index_(index), texture_count_(texture_count) {}

    Bsdf bsdf() {
        switch (const auto kind = in_.get<std::uint8_t>()) {
            case 0:
                return DiffuseMaterial{color()};
            case 1: {
                ConductorMaterial m;
                m.eta = get_vector<Rgb>(in_);
                m.k = get_vector<Rgb>(in_);
                m.specular_reflectance = color();
                m.roughness = roughness();
                return m;
            }
            case 2: {
                DielectricMaterial m;
                m.eta = in_.get<float>();
                m.specular_reflectance = color();
                m.specular_transmittance = color();
                m.roughness = roughness();
                return m;
            }
            case 3: {
                ThinDielectricMaterial m;
                m.eta = in_.get<float>();
                m.specular_reflectance = color();
                m.specular_transmittance = color();
                return m;
            }
            case 4: {
                PlasticMaterial m;
                m.eta = in_.get<float>();
                m.diffuse_reflectance = color();
                m.specular_reflectance = color();
                m.nonlinear = get_flag(in_, "nonlinear");
                m.roughness = roughness();
                m.single_return = get_flag(in_, "single_return");
                return m;
            }
            case 5: {
                BlendMaterial m;
                m.weight = number();
                m.first = get_index(in_, index_, "blended material");
                m.second = get_index(in_, index_, "blended material");
                return m;
            }
            case 6:
                return NullMaterial{};
            default:
                throw FormatError("scene: unknown kind of material " + std::to_string(kind));
        }
    }

    Material material() {
        Material material;
        material.bsdf = bsdf();
        material.twosided = get_flag(in_, "twosided");
        material.back = get_optional_index(in_, index_, "material of the back");
        if (material.back != kNone && !material.twosided)
            throw FormatError("scene: a material that is not twosided has another one for its back");
        material.unlimited = get_flag(in_, "unlimited");
        material.opacity = number();
        material.detail.bump = get_optional_index(in_, texture_count_, "bump texture");
        material.detail.bump_scale = in_.get<float>();
        material.detail.normal_map = get_optional_index(in_, texture_count_, "normal map");
        material.name = in_.get_string();
        material.where = get_location(in_);
        return material;
    }

  private:
    ColorInput color() { return get_color(in_, texture_count_); }
    FloatInput number() { return get_number(in_, texture_count_); }

    Roughness roughness() {
        Roughness roughness;
        roughness.distribution = get_enum(in_, Microfacets::beckmann, "microfacet distribution");
        roughness.alpha_u = number();
        roughness.alpha_v = number();
        return roughness;
    }

    ByteReader& in_;
    std::size_t index_, texture_count_;
};

}  // namespace

void put_material(ByteWriter& out, const Material& material) {
    out.put(static_cast<std::uint8_t>(material.bsdf.index()));
    std::visit(Put{out}, material.bsdf);
    put_flag(out, material.twosided);
    out.put(material.back);
    put_flag(out, material.unlimited);
    put_number(out, material.opacity);
    out.put(material.detail.bump);
    out.put(material.detail.bump_scale);
    out.put(material.detail.normal_map);
    out.put_string(material.name);
    put_location(out, material.where);
}

Material get_material(ByteReader& in, std::size_t index, std::size_t texture_count) {
    return MaterialReader(in, index, texture_count).material();
}

}  // namespace treefarm::packed
