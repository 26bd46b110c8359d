// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/shape_reader.h"

#include <utility>

#include "coordinator/input/check/validation.h"
#include "coordinator/input/mitsuba/emitters.h"
#include "coordinator/input/mitsuba/mesh_files.h"
#include "coordinator/input/mitsuba/shapes.h"

namespace treefarm::mitsuba {
namespace {

bool is_type(const XmlElement& shape, const char* type) {
    const std::string* found = shape.find("type");
    return found && lower_case(*found) == type;
}

}  // namespace

void ShapeReader::read(const XmlElement& shape) {
    if (is_type(shape, "shapegroup"))
        group_of(shape);
    else if (is_type(shape, "instance"))
        read_instance(shape);
    else if (is_type(shape, "merge"))
        read_merged(shape, kNone);
    else
        read_shape(shape, kNone);
}

void ShapeReader::read_merged(const XmlElement& element, std::int32_t group) {
    Properties properties(element, document_, diagnostics_);
    properties.type();
    for (const Child& child : properties.children("shape")) {
        if (is_type(*child.object, "instance") || is_type(*child.object, "shapegroup") ||
            is_type(*child.object, "merge"))
            diagnostics_.unsupported(child.where, "only plain shapes are available within merge in this version",
                                     "place the shape directly");
        else
            read_shape(*child.object, group);
    }
    properties.finish();
}

void ShapeReader::read_shape(const XmlElement& element, std::int32_t group) {
    Properties properties(element, document_, diagnostics_);
    const XmlElement* emitter = properties.only_child("emitter");
    std::vector<Part> parts;
    const XmlElement* bsdf = nullptr;
    if (properties.type() == "obj") {
        for (ObjPart& part : read_obj_parts(properties, materials_, emitter != nullptr, diagnostics_))
            parts.push_back({std::move(part.mesh), part.material});
    } else {
        auto geometry = read_geometry(properties, diagnostics_);
        if (!geometry) return;
        parts.push_back({std::move(*geometry), {}});
        bsdf = bsdf_of(properties, diagnostics_);
    }
    properties.ignore({"silhouette_sampling_weight"});
    properties.finish();
    std::erase_if(parts, [&](const Part& part) { return is_flat(part, element, emitter != nullptr); });
    for (Part& part : parts)
        if (part.material.material == kNone)
            part.material.material =
                bsdf ? materials_.read(*bsdf) : materials_.read_default(emitter != nullptr, element.where);
    if (group != kNone) {
        const auto refuse = [&](const Location& where) {
            diagnostics_.unsupported(where, "a shape in a shapegroup has an emitter",
                                     "take the shape out of the group");
        };
        if (emitter) refuse(emitter->where);
        emitter = nullptr;
        for (Part& part : parts) {
            if (!is_black(part.material.emission)) refuse(part.material.where);
            part.material.emission = Rgb(0.0f);
        }
    }
    for (Part& part : parts)
        add(std::move(part), properties, emitter, group);
}

bool ShapeReader::is_flat(const Part& part, const XmlElement& element, bool on_emitter) {
    const Mesh* mesh = std::get_if<Mesh>(&part.geometry);
    if (mesh == nullptr || !validation::is_flat(*mesh)) return false;
    diagnostics_.warn(element.where, "no triangle of the shape has an area: it is left out",
                      on_emitter ? "zero-area emitter" : "degenerate triangles");
    return true;
}

void ShapeReader::add(Part part, const Properties& properties, const XmlElement* emitter, std::int32_t group) {
    if (const Mesh* mesh = std::get_if<Mesh>(&part.geometry)) triangles_ += mesh->triangle_count();
    diagnostics_.limits().check_triangles(triangles_, properties.where());
    Shape shape;
    shape.geometry = std::move(part.geometry);
    shape.name = properties.id();
    shape.where = properties.where();
    shape.group = group;
    shape.material = part.material.material;
    const auto index = static_cast<std::int32_t>(scene_.shapes.size());
    if (!emitter && !is_black(part.material.emission)) {
        shape.emitter = static_cast<std::int32_t>(scene_.emitters.size());
        scene_.emitters.push_back({AreaEmitter{part.material.emission, index}, part.material.where});
    }
    scene_.shapes.push_back(std::move(shape));
    if (emitter) read_area_emitter(*emitter, index, scene_, materials_.textures(), document_, diagnostics_);
}

std::int32_t ShapeReader::group_of(const XmlElement& element) {
    if (const auto known = groups_.find(&element); known != groups_.end()) return known->second;
    Properties properties(element, document_, diagnostics_);
    properties.type();
    const std::size_t before = scene_.shapes.size();
    const Imath::V3d world_shift = std::exchange(diagnostics_.world_shift, Imath::V3d(0.0));
    for (const Child& child : properties.children("shape")) {
        if (is_type(*child.object, "instance") || is_type(*child.object, "shapegroup"))
            diagnostics_.unsupported(child.where, "instances and shapegroups within a shapegroup are not available",
                                     "place the inner shapes directly");
        else if (is_type(*child.object, "merge"))
            read_merged(*child.object, scene_.group_count);
        else
            read_shape(*child.object, scene_.group_count);
    }
    diagnostics_.world_shift = world_shift;
    properties.finish();
    const bool is_empty = scene_.shapes.size() == before;
    if (is_empty) diagnostics_.unsupported(element.where, "the shapegroup has no shapes", "give it one");
    const std::int32_t group = is_empty ? kNone : scene_.group_count++;
    groups_.emplace(&element, group);
    return group;
}

void ShapeReader::read_instance(const XmlElement& element) {
    Properties properties(element, document_, diagnostics_);
    properties.type();
    const XmlElement* placed = properties.only_child("shape");
    if (!placed || !is_type(*placed, "shapegroup"))
        throw InputError(element.where, "the instance places no shapegroup",
                         "add <ref id=\"...\"/> with the id of a shapegroup");
    Instance instance;
    instance.to_world = Imath::M44f(properties.transform("to_world"));
    properties.finish();
    instance.group = group_of(*placed);
    if (instance.group == kNone) {
        diagnostics_.warn(element.where, "the instance places a shapegroup without shapes: it is skipped");
        return;
    }
    Shape shape;
    shape.geometry = instance;
    shape.name = properties.id();
    shape.where = element.where;
    scene_.shapes.push_back(std::move(shape));
}

}  // namespace treefarm::mitsuba
