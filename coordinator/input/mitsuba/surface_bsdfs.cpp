// SPDX-License-Identifier: Apache-2.0
#include "common/base/text/parse_text.h"
#include "coordinator/input/colour/metals.h"
#include "coordinator/input/colour/scattering_media.h"
#include "coordinator/input/mitsuba/materials.h"
#include "coordinator/input/mitsuba/refractive_index.h"

namespace treefarm::mitsuba {
namespace {

using Bsdf = decltype(Material::bsdf);

std::string lower(std::string text) {
    for (char& c : text)
        if ('A' <= c && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

class SurfaceReader {
  public:
    SurfaceReader(Properties& properties, TextureReader& textures, const SceneDocument& document,
                  Diagnostics& diagnostics)
        : properties_(properties), textures_(textures), document_(document), diagnostics_(diagnostics) {}

    Bsdf diffuse() {
        // Version 0.6 accepts both names.
        const bool long_name = properties_.has("diffuse_reflectance") ||
                               properties_.named_child("texture", "diffuse_reflectance") != nullptr;
        return DiffuseMaterial{reflectance(long_name ? "diffuse_reflectance" : "reflectance", 0.5f)};
    }

    Bsdf conductor(bool rough) {
        ConductorMaterial conductor;
        const bool is_old = properties_.element().version < 2;
        const bool has_eta = properties_.has("eta");
        const std::string name = properties_.text("material", is_old ? "Cu" : "none");
        if (!is_old && has_eta && properties_.has("material"))
            throw InputError(properties_.where("material"), "both a material and eta are given", "keep one of them");
        if (lower(name) != "none") {
            const auto metal = find_metal(name);
            if (!metal) throw unknown_material("no metal", name, nearest_word(name, metal_names()), "give eta and k");
            conductor.eta = metal->eta;
            conductor.k = metal->k;
        }
        conductor.eta = textures_.constant(properties_, "eta", conductor.eta, ColorUse::metal);
        conductor.k = textures_.constant(properties_, "k", conductor.k, ColorUse::metal);
        if (is_old) {
            const auto outside = static_cast<float>(read_refractive_index(properties_, "ext_eta", "air"));
            conductor.eta /= outside;
            conductor.k /= outside;
        }
        // Without a real part everything is reflected, whatever k is.
        if (is_black(conductor.eta)) conductor.k = Rgb(1.0f);
        conductor.specular_reflectance = reflectance("specular_reflectance", 1.0f);
        if (rough) conductor.roughness = roughness(true);
        return conductor;
    }

    Bsdf dielectric(bool rough) {
        DielectricMaterial dielectric;
        dielectric.eta = read_relative_index(properties_, "bk7");
        dielectric.specular_reflectance = reflectance("specular_reflectance", 1.0f);
        dielectric.specular_transmittance = reflectance("specular_transmittance", 1.0f);
        if (rough) dielectric.roughness = roughness(true);
        return dielectric;
    }

    Bsdf thin_dielectric() {
        ThinDielectricMaterial thin;
        thin.eta = read_relative_index(properties_, "bk7");
        thin.specular_reflectance = reflectance("specular_reflectance", 1.0f);
        thin.specular_transmittance = reflectance("specular_transmittance", 1.0f);
        return thin;
    }

    Bsdf plastic(bool rough) {
        PlasticMaterial plastic;
        plastic.eta = read_relative_index(properties_, "polypropylene");
        plastic.diffuse_reflectance = reflectance("diffuse_reflectance", 0.5f);
        plastic.specular_reflectance = reflectance("specular_reflectance", 1.0f);
        plastic.nonlinear = properties_.boolean("nonlinear", false);
        if (rough) plastic.roughness = roughness(false);
        plastic.single_return = rough && properties_.element().version >= 2;
        return plastic;
    }

    /// Reads a coating; the reader of materials adds the coated material.
    Bsdf coating(bool rough) {
        CoatingMaterial coating;
        coating.eta = read_relative_index(properties_, "bk7");
        coating.specular_reflectance = reflectance("specular_reflectance", 1.0f);
        const float thickness = this->thickness();
        coating.absorption = coefficient("sigma_a", Rgb(0.0f));
        coating.absorption.value *= thickness;
        if (rough) coating.roughness = roughness(false);
        return coating;
    }

    /// Reads rough diffuse; Mitsuba 0.6 accepts two names of the reflectance.
    Bsdf rough_diffuse() {
        RoughDiffuseMaterial rough;
        rough.reflectance = reflectance(has_input("reflectance") ? "reflectance" : "diffuse_reflectance", 0.5f);
        rough.alpha = textures_.number(properties_, "alpha", 0.2f);
        rough.fast = properties_.boolean("use_fast_approx", false);
        return rough;
    }

    Bsdf diffuse_transmitter() { return DiffuseTransmitterMaterial{reflectance("transmittance", 0.5f)}; }

    /// Reads a thin layer. Depths are coefficients times the thickness; missing ones come from a medium.
    Bsdf thin_layer() {
        ThinLayerMaterial layer;
        const bool by_extinction = has_input("sigma_t") || has_input("albedo");
        if (by_extinction) {
            refuse_beside(has_input("albedo") ? "albedo" : "sigma_t", {"material", "sigma_s", "sigma_a"});
            if (!has_input("sigma_t") || !has_input("albedo"))
                throw InputError(properties_.where(has_input("albedo") ? "albedo" : "sigma_t"),
                                 "one of sigmaT and albedo is given alone", "give both, or sigmaS and sigmaA");
            const Rgb sigma_t = textures_.constant(properties_, "sigma_t", Rgb(1.0f), ColorUse::coefficient);
            const Rgb albedo = textures_.constant(properties_, "albedo", Rgb(0.0f), ColorUse::reflectance);
            layer.scattering = sigma_t * albedo;
            layer.absorption = sigma_t * (Rgb(1.0f) - albedo);
        } else {
            for (const char* name : {"sigma_s", "sigma_a"})
                if (has_input(name)) refuse_beside(name, {"material"});
            const ScatteringMedium medium = scattering_medium();
            layer.scattering = coefficient("sigma_s", medium.scattering);
            layer.absorption = coefficient("sigma_a", medium.absorption);
        }
        const float thickness = this->thickness();
        layer.scattering.value *= thickness;
        layer.absorption.value *= thickness;
        if (const XmlElement* phase = properties_.only_child("phase")) layer.mean_cosine = mean_cosine(*phase);
        return layer;
    }

    Bsdf phong() {
        PhongMaterial phong;
        phong.diffuse_reflectance = reflectance("diffuse_reflectance", 0.5f);
        phong.specular_reflectance = reflectance("specular_reflectance", 0.2f);
        phong.exponent = textures_.number(properties_, "exponent", 30.0f);
        return phong;
    }

    Bsdf ward() {
        WardMaterial ward;
        ward.diffuse_reflectance = reflectance("diffuse_reflectance", 0.5f);
        ward.specular_reflectance = reflectance("specular_reflectance", 0.2f);
        const std::string variant = lower(properties_.text("variant", "balanced"));
        if (variant == "ward")
            ward.variant = WardVariant::ward;
        else if (variant == "ward-duer")
            ward.variant = WardVariant::duer;
        else if (variant != "balanced")
            throw InputError(properties_.where("variant"), "unknown variant of Ward's model " + in_quotes(variant),
                             "use ward, ward-duer or balanced");
        const FloatInput general = alpha("alpha", 0.1f);
        ward.roughness.alpha_u = has_input("alpha_u") ? alpha("alpha_u", 0.1f) : general;
        ward.roughness.alpha_v = has_input("alpha_v") ? alpha("alpha_v", 0.1f) : general;
        return ward;
    }

    Bsdf principled() {
        PrincipledMaterial principled;
        principled.base_color = reflectance("base_color", 0.5f);
        principled.roughness = number("roughness", 0.5f);
        principled.anisotropic = number("anisotropic", 0.0f);
        principled.metallic = number("metallic", 0.0f);
        principled.spec_trans = number("spec_trans", 0.0f);
        principled.spec_tint = number("spec_tint", 0.0f);
        principled.sheen = number("sheen", 0.0f);
        principled.sheen_tint = number("sheen_tint", 0.0f);
        principled.flatness = number("flatness", 0.0f);
        principled.clearcoat = number("clearcoat", 0.0f);
        principled.clearcoat_gloss = number("clearcoat_gloss", 0.0f);
        principled.eta = principled_eta(principled.transmits());
        // The sampling of directions does not change the image.
        properties_.ignore(
            {"main_specular_sampling_rate", "clearcoat_sampling_rate", "diffuse_reflectance_sampling_rate"});
        return principled;
    }

    Bsdf principled_thin() {
        PrincipledThinMaterial thin;
        thin.base_color = reflectance("base_color", 0.5f);
        thin.roughness = number("roughness", 0.5f);
        thin.anisotropic = number("anisotropic", 0.0f);
        thin.spec_trans = number("spec_trans", 0.0f);
        thin.spec_tint = number("spec_tint", 0.0f);
        thin.sheen = number("sheen", 0.0f);
        thin.sheen_tint = number("sheen_tint", 0.0f);
        thin.flatness = number("flatness", 0.0f);
        thin.diff_trans = number("diff_trans", 0.0f);
        thin.eta = number("eta", 1.5f);
        // The sampling of directions does not change the image.
        properties_.ignore({"specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate",
                            "diffuse_reflectance_sampling_rate", "diffuse_transmittance_sampling_rate"});
        return thin;
    }

  private:
    /// Index of refraction from eta or specular. With transmission it must not be 1; like Mitsuba, it is then moved
    /// away slightly.
    float principled_eta(bool transmits) {
        if (properties_.has("eta") && properties_.has("specular"))
            throw InputError(properties_.where("specular"), "both eta and specular are given", "keep one of them");
        if (properties_.has("eta")) {
            const auto eta = static_cast<float>(properties_.number("eta", 1.5));
            return transmits && eta == 1.0f ? 1.001f : eta;
        }
        const auto specular = static_cast<float>(properties_.number("specular", 0.5));
        if (!(specular >= 0.0f && specular <= 1.0f))
            throw InputError(properties_.where("specular"), "a specular of " + number_text(specular), "give 0 to 1");
        const float bounded = transmits ? std::max(specular, 1e-3f) : specular;
        return 2.0f / (1.0f - std::sqrt(0.08f * bounded)) - 1.0f;
    }

    FloatInput number(const char* name, float otherwise) { return textures_.number(properties_, name, otherwise); }

    ColorInput coefficient(const char* name, const Rgb& otherwise) {
        return textures_.color(properties_, name, otherwise, ColorUse::coefficient);
    }

    InputError unknown_material(const std::string& none, const std::string& name, const std::string& nearest,
                                const char* otherwise) const {
        return {properties_.where("material"), none + " is called " + in_quotes(name),
                nearest.empty() ? otherwise : "did you mean " + in_quotes(nearest) + "?"};
    }

    /// The named medium, in Mitsuba 0.6's unit: a hundred times the value per millimetre.
    ScatteringMedium scattering_medium() {
        const std::string name = properties_.text("material", "skin1");
        auto medium = find_medium(lower(name));
        if (!medium)
            throw unknown_material("no scattering medium", name, nearest_word(lower(name), medium_names()),
                                   "give sigmaS and sigmaA");
        const float scale = 100.0f * static_cast<float>(properties_.positive("scale", 1.0));
        return {medium->scattering * scale, medium->absorption * scale};
    }

    void refuse_beside(const char* given, std::initializer_list<const char*> others) {
        for (const char* other : others)
            if (has_input(other))
                throw InputError(properties_.where(other), std::string(other) + " is given beside " + given,
                                 "keep one of them");
    }

    float thickness() {
        const auto thickness = static_cast<float>(properties_.number("thickness", 1.0));
        if (!(thickness >= 0.0f && thickness <= 1e30f))
            throw InputError(properties_.where("thickness"), "a thickness of " + number_text(thickness),
                             "give 0 or more, in the inverse unit of sigmaA");
        return thickness;
    }

    float mean_cosine(const XmlElement& element) {
        Properties phase(element, document_, diagnostics_);
        float g = 0.0f;
        if (phase.type() == "hg") {
            g = static_cast<float>(phase.number("g", 0.8));
            if (!(std::abs(g) <= ThinLayerMaterial::kMostCosine))
                throw InputError(phase.where("g"), "a mean cosine of " + number_text(g), "give -0.99 to 0.99");
        } else if (phase.type() != "isotropic") {
            diagnostics_.unsupported(
                phase.where(), "the phase function " + in_quotes(phase.type()) + " is not available in this version",
                "use isotropic or hg", "it is isotropic");
            phase.ignore_values();
        }
        phase.finish();
        return g;
    }

    ColorInput reflectance(const char* name, float otherwise) {
        return textures_.color(properties_, name, Rgb(otherwise), ColorUse::reflectance);
    }

    FloatInput alpha(const std::string& name, float otherwise) {
        FloatInput alpha = textures_.number(properties_, name, otherwise);
        const Location& where = properties_.where(name);
        if (!(alpha.value >= 0.0f) || !(alpha.value <= 100.0f))
            throw InputError(where, "a roughness of " + number_text(alpha.value), "give more than 0");
        if (!alpha.varies() && alpha.value < Roughness::kLeastAlpha) {
            diagnostics_.warn(where,
                              "a roughness below 1e-4 was raised to it, as Mitsuba does: for a smooth surface "
                              "use the BSDF without \"rough\" in its name",
                              "extreme alpha");
            alpha.value = Roughness::kLeastAlpha;
        }
        return alpha;
    }

    Roughness roughness(bool anisotropic) {
        Roughness roughness;
        roughness.distribution = Microfacets::beckmann;
        const std::string name = lower(properties_.text("distribution", "beckmann"));
        if (name == "ggx")
            roughness.distribution = Microfacets::ggx;
        else if (name == "phong" || name == "as")
            diagnostics_.unsupported(
                properties_.where("distribution"),
                "the microfacet distribution " + in_quotes(name) + " is not available in this version",
                "use beckmann or ggx", "beckmann is used");
        else if (name != "beckmann")
            throw InputError(properties_.where("distribution"), "unknown microfacet distribution " + in_quotes(name),
                             "use beckmann or ggx");
        const bool has_u = has_input("alpha_u"), has_v = has_input("alpha_v");
        if (anisotropic && (has_u || has_v)) {
            if (!has_u || !has_v || has_input("alpha"))
                throw InputError(properties_.where(has_u ? "alpha_u" : "alpha_v"),
                                 "a roughness is given in one direction, or in one and in general",
                                 "give alpha alone, or alphaU and alphaV");
            roughness.alpha_u = alpha("alpha_u", 0.1f);
            roughness.alpha_v = alpha("alpha_v", 0.1f);
        } else {
            roughness.alpha_u = roughness.alpha_v = alpha("alpha", 0.1f);
        }
        // The sampling of directions does not change the image.
        properties_.ignore({"sample_visible"});
        return roughness;
    }

    bool has_input(const std::string& name) {
        return properties_.has(name) || properties_.named_child("texture", name) != nullptr;
    }

    Properties& properties_;
    TextureReader& textures_;
    const SceneDocument& document_;
    Diagnostics& diagnostics_;
};

struct SurfaceType {
    std::string_view name;
    Bsdf (*read)(SurfaceReader& reader);
};

constexpr SurfaceType kTypes[] = {
    {"diffuse", [](SurfaceReader& reader) { return reader.diffuse(); }},
    {"conductor", [](SurfaceReader& reader) { return reader.conductor(false); }},
    {"roughconductor", [](SurfaceReader& reader) { return reader.conductor(true); }},
    {"dielectric", [](SurfaceReader& reader) { return reader.dielectric(false); }},
    {"roughdielectric", [](SurfaceReader& reader) { return reader.dielectric(true); }},
    {"thindielectric", [](SurfaceReader& reader) { return reader.thin_dielectric(); }},
    {"plastic", [](SurfaceReader& reader) { return reader.plastic(false); }},
    {"roughplastic", [](SurfaceReader& reader) { return reader.plastic(true); }},
    {"roughdiffuse", [](SurfaceReader& reader) { return reader.rough_diffuse(); }},
    {"phong", [](SurfaceReader& reader) { return reader.phong(); }},
    {"difftrans", [](SurfaceReader& reader) { return reader.diffuse_transmitter(); }},
    {"ward", [](SurfaceReader& reader) { return reader.ward(); }},
    {"principled", [](SurfaceReader& reader) { return reader.principled(); }},
    {"principledthin", [](SurfaceReader& reader) { return reader.principled_thin(); }},
    {"coating", [](SurfaceReader& reader) { return reader.coating(false); }},
    {"roughcoating", [](SurfaceReader& reader) { return reader.coating(true); }},
    {"hk", [](SurfaceReader& reader) { return reader.thin_layer(); }},
    {"null", [](SurfaceReader&) { return Bsdf{NullMaterial{}}; }},
};

}  // namespace

std::optional<Bsdf> read_surface_bsdf(Properties& properties, TextureReader& textures, const SceneDocument& document,
                                      Diagnostics& diagnostics) {
    for (const SurfaceType& type : kTypes) {
        if (properties.type() != type.name) continue;
        SurfaceReader reader(properties, textures, document, diagnostics);
        return type.read(reader);
    }
    return std::nullopt;
}

std::vector<std::string_view> surface_bsdf_names() {
    std::vector<std::string_view> names;
    for (const SurfaceType& type : kTypes)
        names.push_back(type.name);
    return names;
}

}  // namespace treefarm::mitsuba
