// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/materials.h"

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/values.h"

namespace treefarm::mitsuba {
namespace {

constexpr const char* kCure = "use one of those listed in docs/use/scenes.md";

std::string nearest_type(const std::string& type) {
    std::vector<std::string_view> known = surface_bsdf_names();
    known.insert(known.end(), {"twosided", "mask", "bumpmap", "normalmap", "blendbsdf", "mixturebsdf"});
    return did_you_mean(type, known, kCure);
}

/// Effect that an unsupported BSDF would simulate.
std::string effect_of(const std::string& type) {
    static constexpr std::pair<const char*, const char*> kEffects[] = {{"irawan", "Irawan and Marschner's woven cloth"},
                                                                       {"hair", "hair fibres"},
                                                                       {"measured", "measured BRDFs"},
                                                                       {"measured_polarized", "polarisation"},
                                                                       {"pplastic", "polarisation"},
                                                                       {"polarizer", "polarisation"},
                                                                       {"retarder", "polarisation"},
                                                                       {"circular", "polarisation"}};
    for (const auto& [name, effect] : kEffects)
        if (type == name) return std::string(" (") + effect + ")";
    return "";
}

}  // namespace

std::int32_t MaterialReader::read(const XmlElement& bsdf) {
    const auto known = known_.find(&bsdf);
    if (known != known_.end()) return known->second;
    const std::int32_t index = add(convert(bsdf));
    known_.emplace(&bsdf, index);
    return index;
}

std::int32_t MaterialReader::read_made(XmlElement bsdf) {
    made_.push_back(std::move(bsdf));
    return read(made_.back());
}

std::int32_t MaterialReader::read_default(bool on_emitter, const Location& where) {
    std::int32_t& index = default_[on_emitter ? 1 : 0];
    if (index == kNone) {
        Material material;
        material.bsdf = DiffuseMaterial{Rgb(on_emitter ? 0.0f : 0.5f)};
        material.name = "default";
        material.where = where;
        index = add(std::move(material));
    }
    return index;
}

std::int32_t MaterialReader::add(Material material) {
    constexpr int kMostLeaves = 64;
    const Summary summary = summary_of(material);
    if (summary.leaves > kMostLeaves)
        throw InputError(material.where, "a blend of more than " + std::to_string(kMostLeaves) + " BSDFs",
                         "blend fewer, every ray pays for them");
    summaries_.push_back(summary);
    scene_.materials.push_back(std::move(material));
    return static_cast<std::int32_t>(scene_.materials.size() - 1);
}

const Material& MaterialReader::convert(const XmlElement& bsdf) {
    const auto known = converted_.find(&bsdf);
    if (known != converted_.end()) return known->second;
    return converted_.emplace(&bsdf, convert_new(bsdf)).first->second;
}

Material MaterialReader::convert_new(const XmlElement& bsdf) {
    Properties properties(bsdf, document_, diagnostics_);
    const std::string type = properties.type();
    Material material;
    const bool scales = properties.element().version < 2 && properties.boolean("ensure_energy_conservation", true);
    if (auto surface = read_surface_bsdf(properties, textures_, document_, diagnostics_)) {
        material.bsdf = std::move(*surface);
        material.unlimited = !scales;
        if (auto* coating = std::get_if<CoatingMaterial>(&material.bsdf))
            coating->coated = add_part(convert_child(properties));
    } else if (type == "twosided") {
        material = convert_twosided(properties);
    } else if (type == "mask") {
        material = convert_mask(properties);
    } else if (type == "bumpmap" || type == "bump") {
        material = convert_bump(properties);
    } else if (type == "normalmap") {
        material = convert_normal_map(properties);
    } else if (type == "blendbsdf" || type == "blend") {
        material = convert_blend(properties);
    } else if (type == "mixturebsdf" || type == "mixture") {
        material = convert_mixture(properties);
    } else {
        diagnostics_.unsupported(
            bsdf.where, "the BSDF " + in_quotes(type) + effect_of(type) + " is not available in this version",
            effect_of(type).empty() ? nearest_type(type) : kCure, "it becomes diffuse with reflectance 0.5");
        material.bsdf = DiffuseMaterial{Rgb(0.5f)};
        material.name = properties.id();
        material.where = bsdf.where;
        return material;
    }
    properties.finish();
    if (!properties.id().empty() || material.name.empty()) material.name = properties.id();
    material.where = bsdf.where;
    return material;
}

MaterialReader::Summary MaterialReader::summary_of(const Material& material) const {
    if (const auto* blend = std::get_if<BlendMaterial>(&material.bsdf)) {
        const Summary& first = summaries_[static_cast<std::size_t>(blend->first)];
        const Summary& second = summaries_[static_cast<std::size_t>(blend->second)];
        return {first.transmits || second.transmits, first.leaves + second.leaves};
    }
    const bool transmits = std::visit([](const auto& kind) { return kind.lobes().transmits(); }, material.bsdf);
    if (const auto* coating = std::get_if<CoatingMaterial>(&material.bsdf)) {
        const Summary& beneath = summaries_[static_cast<std::size_t>(coating->coated)];
        return {beneath.transmits, beneath.leaves + 1};
    }
    return {transmits, 1};
}

Material MaterialReader::convert_child(Properties& properties) {
    const XmlElement* child = properties.only_child("bsdf");
    if (child == nullptr)
        throw InputError(properties.where(), properties.title() + " has no BSDF inside", "put one into it");
    return convert(*child);
}

const XmlElement& MaterialReader::texture_inside(Properties& properties, const char* what) {
    const XmlElement* texture = properties.only_child("texture");
    if (texture == nullptr)
        throw InputError(properties.where(), properties.title() + " has no texture inside",
                         std::string("put the texture of ") + what + " into it");
    return *texture;
}

Material MaterialReader::convert_twosided(Properties& properties) {
    const std::vector<Child> sides = properties.children("bsdf");
    if (sides.empty())
        throw InputError(properties.where(), "<bsdf type=\"twosided\"> has no BSDF inside", "put one into it");
    if (sides.size() > 2)
        throw InputError(sides[2].where, "<bsdf type=\"twosided\"> has more than two BSDFs inside", "keep two of them");
    if (properties.element().version >= 3 && properties.boolean("allow_transmission", false))
        diagnostics_.unsupported(properties.where("allow_transmission"),
                                 "transmission inside twosided is not available in this version", "remove it",
                                 "it is ignored");
    Material material = convert(*sides[0].object);
    if (transmits(material)) {
        diagnostics_.unsupported(sides[0].where, "a BSDF that transmits light is inside <bsdf type=\"twosided\">",
                                 "take it out: it has both sides by nature", "twosided is ignored");
        return material;
    }
    if (sides.size() == 2 && sides[1].object != sides[0].object) {
        Material back = convert(*sides[1].object);
        if (transmits(back) || back.masked() || material.masked() || !(back.detail == material.detail))
            diagnostics_.unsupported(
                sides[1].where, "the sides of <bsdf type=\"twosided\"> differ in more than how they reflect",
                "put masks, bump maps and normal maps around it, and nothing that transmits inside",
                "the back is like the front");
        else
            material.back = add(std::move(back));
    }
    material.twosided = true;
    return material;
}

Material MaterialReader::convert_mask(Properties& properties) {
    const FloatInput opacity = textures_.number(properties, "opacity", 0.5f);
    if (!opacity.varies() && !(opacity.value >= 0.0f && opacity.value <= 1.0f))
        throw InputError(properties.where("opacity"), "an opacity of " + number_text(opacity.value),
                         "give a value from 0 to 1");
    Material material = convert_child(properties);
    if (opacity.varies() && material.opacity.varies()) {
        diagnostics_.unsupported(properties.where("opacity"),
                                 "a textured mask around another is not available in this version",
                                 "combine them in one texture", "the inner one is used");
        return material;
    }
    material.opacity = {opacity.value * material.opacity.value,
                        opacity.varies() ? opacity.texture : material.opacity.texture};
    return material;
}

void MaterialReader::set_detail(Material& material, const NormalDetail& detail, const Properties& properties) {
    if (material.detail.any()) {
        diagnostics_.unsupported(properties.where(),
                                 "a bump or normal map around another is not available in this version",
                                 "keep one of them", "the inner one is used");
        return;
    }
    material.detail = detail;
}

/// Reads the treatment of extremely tilted normals, as in Mitsuba 3, by default since 3.7.1.
void MaterialReader::read_tilt(Properties& properties, NormalDetail& detail) {
    if (properties.element().version < 2) return;
    detail.flip_invalid = properties.boolean("flip_invalid_normals", true);
    detail.shadowed = properties.boolean("use_shadowing_function", true);
}

Material MaterialReader::convert_bump(Properties& properties) {
    const ColorInput map = textures_.heights(texture_inside(properties, "displacements"));
    NormalDetail detail;
    detail.bump = map.texture;
    detail.bump_scale = average(map.value);
    if (properties.element().version >= 2) detail.bump_scale *= static_cast<float>(properties.number("scale", 1.0));
    read_tilt(properties, detail);
    Material material = convert_child(properties);
    if (map.varies()) set_detail(material, detail, properties);
    return material;
}

Material MaterialReader::convert_normal_map(Properties& properties) {
    ColorInput map = textures_.normals(texture_inside(properties, "normals"));
    NormalDetail detail;
    read_tilt(properties, detail);
    Material material = convert_child(properties);
    if (!map.varies()) {
        // One normal everywhere: a checkerboard of one colour.
        map.texture = static_cast<std::int32_t>(scene_.textures.size());
        scene_.textures.push_back({CheckerboardTexture{Rgb(1.0f), Rgb(1.0f), {}}, "", properties.where()});
    }
    detail.normal_map = map.texture;
    detail.normal_scale = map.value;
    set_detail(material, detail, properties);
    return material;
}

std::int32_t MaterialReader::add_part(Material material) {
    if (!material.masked()) return add(std::move(material));
    BlendMaterial masked;
    masked.weight = material.opacity;
    const Location where = material.where;
    Material nothing;
    nothing.bsdf = NullMaterial{};
    nothing.where = where;
    material.opacity = 1.0f;
    masked.first = add(std::move(nothing));
    masked.second = add(std::move(material));
    Material result;
    result.bsdf = masked;
    result.where = where;
    return add(std::move(result));
}

Material MaterialReader::blend(const FloatInput& weight, Material first, Material second,
                               const Properties& properties) {
    Material material;
    if (first.detail == second.detail) {
        material.detail = first.detail;
        first.detail = second.detail = {};
    }
    const bool transmissive = transmits(first) || transmits(second) || first.masked() || second.masked();
    if (!transmissive && first.twosided != second.twosided) {
        diagnostics_.unsupported(properties.where(),
                                 "one BSDF of " + properties.title() + " is two-sided and the other is not",
                                 "put twosided around the blend", "both are two-sided");
        first.twosided = second.twosided = true;
    }
    if (!transmissive && (first.back != kNone || second.back != kNone)) {
        diagnostics_.unsupported(
            properties.where(),
            "two-sided BSDFs with different sides inside " + properties.title() + " are not available in this version",
            "put twosided around blends", "the backs are like the fronts");
        first.back = second.back = kNone;
    }
    material.twosided = !transmissive && first.twosided;
    BlendMaterial mixed;
    mixed.weight = weight;
    mixed.first = add_part(std::move(first));
    mixed.second = add_part(std::move(second));
    material.bsdf = mixed;
    material.where = properties.where();
    return material;
}

Material MaterialReader::convert_blend(Properties& properties) {
    const FloatInput weight = textures_.number(properties, "weight", 0.5f);
    if (!weight.varies() && !(weight.value >= 0.0f && weight.value <= 1.0f))
        throw InputError(properties.where("weight"), "a weight of " + number_text(weight.value),
                         "give a value from 0 to 1");
    const std::vector<Child> parts = properties.children("bsdf");
    if (parts.size() != 2)
        throw InputError(properties.where(),
                         properties.title() + " has " + std::to_string(parts.size()) + " BSDFs inside, not 2",
                         "give two");
    Material first = convert(*parts[0].object), second = convert(*parts[1].object);
    return blend(weight, std::move(first), std::move(second), properties);
}

Material MaterialReader::convert_mixture(Properties& properties) {
    const std::vector<Child> parts = properties.children("bsdf");
    const Location& where = properties.where("weights");
    const std::vector<double> weights = numbers_of(properties.text("weights", ""), where);
    if (weights.size() != parts.size() || parts.empty())
        throw InputError(where,
                         properties.title() + " has " + std::to_string(parts.size()) + " BSDFs and " +
                             std::to_string(weights.size()) + " weights",
                         "give as many of one as of the other");
    double total = 0.0;
    for (const double weight : weights) {
        if (!(weight >= 0.0)) throw InputError(where, "a weight of " + number_text(weight), "give 0 or more");
        total += weight;
    }
    if (!(total > 0.0)) throw InputError(where, "the weights are all 0", "give one that is positive");
    if (total > 1.0) diagnostics_.warn(where, "the weights sum up to more than 1 and were scaled down to it");

    // From last to first: each blend adds a BSDF to the following ones. Weights that sum to less than 1 are filled up
    // with black.
    Material mixed = convert(*parts.back().object);
    double rest = weights.back();
    if (total < 1.0) {
        Material black;
        black.bsdf = DiffuseMaterial{Rgb(0.0f)};
        black.twosided = mixed.twosided;
        const double missing = 1.0 - total;
        mixed = blend(static_cast<float>(missing / (missing + rest)), std::move(mixed), std::move(black), properties);
        rest += 1.0 - total;
    }
    for (std::size_t i = parts.size() - 1; i-- > 0;) {
        Material part = convert(*parts[i].object);
        const double fraction = rest + weights[i] > 0.0 ? rest / (rest + weights[i]) : 0.0;
        mixed = blend(static_cast<float>(fraction), std::move(part), std::move(mixed), properties);
        rest += weights[i];
    }
    return mixed;
}

}  // namespace treefarm::mitsuba
