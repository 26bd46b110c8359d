// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/file_search.h"
#include "coordinator/input/mitsuba/obj_materials.h"

namespace treefarm::mitsuba {
namespace {

XmlElement object(const char* tag, const char* type, const Location& where) {
    XmlElement element;
    element.tag = tag;
    element.attributes = {{"type", type}};
    element.where = where;
    return element;
}

void add_value(XmlElement& to, const char* tag, const char* name, const std::string& value) {
    XmlElement element;
    element.tag = tag;
    element.attributes = {{"name", name}, {"value", value}};
    element.where = to.where;
    to.children.push_back(std::move(element));
}

void add_color(XmlElement& to, const char* name, const Rgb& color) {
    add_value(to, "rgb", name, number_text(color.x) + " " + number_text(color.y) + " " + number_text(color.z));
}

float largest(const Rgb& color) {
    return std::max(color.x, std::max(color.y, color.z));
}

/// Limits a reflectance to 1, which rounding may exceed.
Rgb at_most_1(const Rgb& color) {
    return Rgb(std::min(color.x, 1.0f), std::min(color.y, 1.0f), std::min(color.z, 1.0f));
}

XmlElement diffuse_of(const MtlMaterial& material, const Rgb& reflectance, const std::filesystem::path& folder) {
    XmlElement diffuse = object("bsdf", "diffuse", material.where);
    if (material.diffuse_map.empty()) {
        add_color(diffuse, "reflectance", reflectance);
        return diffuse;
    }
    XmlElement scale = object("texture", "scale", material.diffuse_map_where);
    scale.attributes.push_back({"name", "reflectance"});
    add_color(scale, "scale", reflectance);
    XmlElement map = object("texture", "bitmap", material.diffuse_map_where);
    add_value(map, "string", "filename", FileSearch(folder).find(material.diffuse_map, folder).string());
    scale.children.push_back(std::move(map));
    diffuse.children.push_back(std::move(scale));
    return diffuse;
}

XmlElement mirror_of(const MtlMaterial& material, const Rgb& reflectance) {
    XmlElement mirror = object("bsdf", "roughconductor", material.where);
    add_value(mirror, "string", "material", "none");
    add_value(mirror, "float", "alpha", number_text(std::clamp(std::sqrt(2.0 / (material.exponent + 2.0)), 1e-3, 1.0)));
    add_color(mirror, "specularReflectance", reflectance);
    return mirror;
}

}  // namespace

XmlElement bsdf_of_mtl(const MtlMaterial& material, const std::filesystem::path& folder) {
    // A map replaces Kd, which some programs write as black beside it.
    const Rgb kd = material.diffuse_map.empty() ? material.diffuse : Rgb(1.0f);
    const Rgb ks = material.has_specular ? material.specular : Rgb(0.0f);
    const float diffuse = largest(kd), specular = largest(ks), total = std::max(diffuse + specular, 1.0f);
    XmlElement twosided = object("bsdf", "twosided", material.where);
    twosided.attributes.push_back({"id", material.name});
    if (specular == 0.0f) {
        twosided.children.push_back(diffuse_of(material, kd / total, folder));
        return twosided;
    }
    if (diffuse == 0.0f) {
        twosided.children.push_back(mirror_of(material, ks / total));
        return twosided;
    }
    const float weight = specular / (diffuse + specular);
    XmlElement blend = object("bsdf", "blendbsdf", material.where);
    add_value(blend, "float", "weight", number_text(weight));
    blend.children.push_back(diffuse_of(material, at_most_1(kd / (total * (1.0f - weight))), folder));
    blend.children.push_back(mirror_of(material, at_most_1(ks / (total * weight))));
    twosided.children.push_back(std::move(blend));
    return twosided;
}

}  // namespace treefarm::mitsuba
