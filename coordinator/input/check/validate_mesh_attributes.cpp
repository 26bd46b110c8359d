// SPDX-License-Identifier: Apache-2.0
#include "common/base/text/parse_text.h"
#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/mesh_attribute_uses.h"
#include "coordinator/input/check/validation.h"

namespace treefarm::validation {
namespace {

std::string list_of(const std::vector<MeshAttribute>& attributes) {
    std::string list;
    for (const MeshAttribute& attribute : attributes)
        list += (list.empty() ? "" : ", ") + attribute.name;
    return list;
}

void check(const Shape& shape, const std::string& name) {
    const auto refuse = [&](const std::string& what, const std::string& cure) {
        throw InputError(shape.where,
                         (shape.name.empty() ? "the shape " : "shape " + in_quotes(shape.name) + " ") + what, cure);
    };
    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
    if (!mesh)
        refuse("is no mesh, so it has no " + name + ", which its texture asks for",
               "make it a mesh from a PLY file, or give it another texture");
    const MeshAttribute* attribute = mesh->find_attribute(name);
    if (!attribute)
        refuse("has no " + name + ", which its texture asks for",
               mesh->attributes.empty()
                   ? "give the " + std::string(MeshAttribute::is_of_faces(name) ? "faces" : "vertices") +
                         " of its PLY file these properties (red, green and blue for a colour), or another texture"
                   : "it has " + list_of(mesh->attributes));
    const std::size_t wanted = attribute->is_of_faces() ? mesh->triangle_count() : mesh->positions.size();
    if (attribute->values.size() != wanted)
        refuse("has " + std::to_string(attribute->values.size()) + " values of " + name + " for its " +
                   std::to_string(wanted) + (attribute->is_of_faces() ? " triangles" : " vertices"),
               "repair the mesh");
    for (const Rgb& value : attribute->values)
        if (!is_finite(value)) refuse("has a " + name + " that is not finite", "repair the mesh");
}

}  // namespace

void check_mesh_attributes(Scene& scene) {
    const std::vector<std::set<std::string>> uses = mesh_attribute_uses(scene);
    for (std::size_t i = 0; i < uses.size(); ++i)
        for (const std::string& name : uses[i])
            check(scene.shapes[i], name);
    for (const Emitter& emitter : scene.emitters) {
        if (shape_of(emitter) != kNone) continue;
        for_each_texture(emitter, [&](std::int32_t texture) {
            const auto at = static_cast<std::size_t>(texture);
            if (texture >= 0 && at < scene.textures.size() && !attribute_of(scene.textures[at]).empty())
                throw InputError(emitter.where, "the emitter has the texture mesh_attribute, but no mesh",
                                 "give it a bitmap");
        });
    }
    remove_unused_attributes(scene);
}

}  // namespace treefarm::validation
