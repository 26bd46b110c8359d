#include "common/scene/mitsuba/materials.h"

#include "common/config/parse_text.h"

namespace treefarm::mitsuba {

std::int32_t MaterialReader::read(const XmlElement& bsdf) {
    const auto known = known_.find(&bsdf);
    if (known != known_.end()) return known->second;
    const std::int32_t index = add(convert(bsdf));
    known_.emplace(&bsdf, index);
    return index;
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
    scene_.materials.push_back(std::move(material));
    return static_cast<std::int32_t>(scene_.materials.size() - 1);
}

Material MaterialReader::convert(const XmlElement& bsdf) {
    Properties properties(bsdf, document_, diagnostics_);
    const std::string type = properties.type();
    Material material;
    if (type == "diffuse") {
        material = convert_diffuse(properties);
        properties.finish();
    } else if (type == "twosided") {
        material = convert_twosided(properties);
        properties.finish();
    } else {
        diagnostics_.unsupported(bsdf.where, "the BSDF " + in_quotes(type) + " is not available in this version",
                                 "use diffuse or twosided, or read with scene.lenient=true to see it grey",
                                 "it becomes diffuse with reflectance 0.5");
    }
    material.name = properties.id();
    material.where = bsdf.where;
    return material;
}

Material MaterialReader::convert_diffuse(Properties& properties) {
    DiffuseMaterial diffuse;
    for (const Child& texture : properties.children("texture"))
        diagnostics_.unsupported(texture.where, "textures are not available in this version", "give an <rgb>",
                                 "reflectance 0.5 is used");
    const bool long_name = properties.has("diffuse_reflectance");
    diffuse.reflectance = properties.color(long_name ? "diffuse_reflectance" : "reflectance", diffuse.reflectance.value,
                                           ColorUse::reflectance);
    Material material;
    material.bsdf = diffuse;
    return material;
}

Material MaterialReader::convert_twosided(Properties& properties) {
    const std::vector<Child> sides = properties.children("bsdf");
    if (sides.empty())
        throw InputError(properties.where(), "<bsdf type=\"twosided\"> has no BSDF inside", "put one into it");
    if (sides.size() > 1 && sides[1].object != sides[0].object)
        diagnostics_.unsupported(sides[1].where, "a different BSDF on the back is not available in this version",
                                 "give a single BSDF", "both sides get the first one");
    Material material = convert(*sides[0].object);
    material.twosided = true;
    return material;
}

}  // namespace treefarm::mitsuba
