// SPDX-License-Identifier: Apache-2.0
#include "common/scene/pack/shape_codec.h"

#include "common/scene/pack/packed_fields.h"

namespace treefarm::packed {
namespace {

/// Kind number of a mesh with attributes, so that other meshes need no mark. Kinds after the first five have the
/// numbers above it.
constexpr std::uint8_t kMeshWithAttributes = 5;

std::uint8_t number_of(const ShapeKind& kind) {
    const auto* mesh = std::get_if<Mesh>(&kind);
    if (mesh && !mesh->attributes.empty()) return kMeshWithAttributes;
    const auto number = static_cast<std::uint8_t>(kind.index());
    return static_cast<std::uint8_t>(number < kMeshWithAttributes ? number : number + 1);
}

ShapeKind kind_of_number(std::uint8_t number) {
    if (number == kMeshWithAttributes) return Mesh{};
    return kind_of<ShapeKind>(number < kMeshWithAttributes ? number : number - std::size_t{1}, "shape");
}

}  // namespace

void put_shape(ByteWriter& out, const Shape& shape) {
    out.put(number_of(shape.geometry));
    visit_fields(shape.geometry, PutFields(out));
    out.put(shape.material);
    out.put(shape.emitter);
    out.put(shape.group);
    out.put_string(shape.name);
}

Shape get_shape(ByteReader& in, std::size_t material_count, std::size_t group_count) {
    Shape shape;
    const auto number = in.get<std::uint8_t>();
    shape.geometry = kind_of_number(number);
    visit_fields(shape.geometry,
                 GetFields(in, {.groups = group_count, .with_attributes = number == kMeshWithAttributes}));
    const bool is_instance = std::holds_alternative<Instance>(shape.geometry);
    shape.material = get_optional_index(in, material_count, "material");
    shape.emitter = in.get<std::int32_t>();
    shape.group = get_optional_index(in, group_count, "group");
    if (is_instance && (shape.material != kNone || shape.group != kNone || shape.emitter != kNone))
        throw FormatError("scene: an instance has a material or an emitter, or is in a group");
    if (!is_instance && shape.material == kNone) throw FormatError("scene: a shape has no material");
    if (shape.group != kNone && shape.emitter != kNone) throw FormatError("scene: an emitter is in a group");
    shape.name = in.get_string();
    return shape;
}

}  // namespace treefarm::packed
