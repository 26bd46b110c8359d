// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_traits.h"
#include "coordinator/input/check/validation.h"

namespace treefarm::validation {
namespace {

[[noreturn]] void refuse(const Shape& shape, const std::string& what, const std::string& cure) {
    throw InputError(shape.where, (shape.name.empty() ? "the shape" : "shape \"" + shape.name + "\"") + " " + what,
                     cure);
}

/// Whether twice the triangle's area is zero, or too small for a normal in single precision.
bool without_area(const Mesh& mesh, std::size_t triangle) {
    const Vec3& a = mesh.positions[mesh.indices[3 * triangle]];
    const Vec3& b = mesh.positions[mesh.indices[3 * triangle + 1]];
    const Vec3& c = mesh.positions[mesh.indices[3 * triangle + 2]];
    const Vec3 normal = cross(b - a, c - a);
    const float squared = dot(normal, normal);
    return !(squared > 0.0f) || !std::isfinite(1.0f / std::sqrt(squared));
}

/// Removes triangles without area and returns their number.
std::size_t drop_degenerate(Mesh& mesh) {
    const std::size_t count = mesh.triangle_count();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (without_area(mesh, i)) continue;
        for (std::size_t k = 0; k < 3; ++k)
            mesh.indices[3 * kept + k] = mesh.indices[3 * i + k];
        for (MeshAttribute& attribute : mesh.attributes)
            if (attribute.is_of_faces()) attribute.values[kept] = attribute.values[i];
        ++kept;
    }
    mesh.indices.resize(3 * kept);
    for (MeshAttribute& attribute : mesh.attributes)
        if (attribute.is_of_faces()) attribute.values.resize(kept);
    return count - kept;
}

/// Checks the values of a kind of shape in the order of its fields(), and rules that involve the scene.
class ShapeCheck {
  public:
    ShapeCheck(Shape& shape, const std::vector<Box3>& groups, std::vector<Warning>& warnings)
        : shape_(shape), groups_(groups), warnings_(warnings) {}

    void run() {
        visit_fields(shape_.geometry, *this);
        std::visit([this](auto& kind) { check_whole(kind); }, shape_.geometry);
    }

    void point(const char* name, const Vec3& value) const {
        if (!is_finite(value))
            refuse(shape_, std::string("is not finite (its ") + name + ")", "check its numbers and its transformation");
        if (is_too_far(value)) refuse(shape_, "has a coordinate beyond 1e18", "scale the scene down");
    }
    void offset(const char* name, const Vec3& value) const { point(name, value); }
    void axis(const char*, const Vec3& value) const {
        if (!is_unit(value))
            refuse(shape_, "has axes that are not unit vectors at right angles", "check its transformation");
    }
    void radius(float value) const {
        if (!std::isfinite(value))
            refuse(shape_, "is not finite (its radius)", "check its radius and its transformation");
        if (!(value > 0.0f)) refuse(shape_, "has a radius that is not positive", "give a positive radius");
        if (value > kFarthest) refuse(shape_, "has a coordinate beyond 1e18", "scale the scene down");
    }
    void flag(const char*, bool) const {}
    void rule(bool holds, const char* what, const char* cure) const {
        if (!holds) refuse(shape_, what, cure);
    }
    void group(std::int32_t index) const {
        if (index < 0 || static_cast<std::size_t>(index) >= groups_.size() ||
            groups_[static_cast<std::size_t>(index)].isEmpty())
            refuse(shape_, "places a group that has no shapes", "give the group a shape");
    }
    void transform(const Imath::M44f& m) const {
        const Imath::V3d rows[3] = {
            {m[0][0], m[0][1], m[0][2]}, {m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}};
        if (m[0][3] != 0.0f || m[1][3] != 0.0f || m[2][3] != 0.0f || m[3][3] != 1.0f)
            refuse(shape_, "has a transformation that is not affine", "its last row must be 0 0 0 1");
        for (const Vec3& row : {Vec3(rows[0]), Vec3(rows[1]), Vec3(rows[2]), Vec3(m[3][0], m[3][1], m[3][2])})
            point("transformation", row);
        const double volume = rows[0].normalized().dot(rows[1].normalized().cross(rows[2].normalized()));
        if (!(std::abs(volume) > 1e-6))
            refuse(shape_, "has a transformation that flattens space", "give no scale of 0");
        for (const Imath::V3d& row : rows)
            if (!(row.length() > 1e-18)) refuse(shape_, "is scaled below 1e-18", "scale the scene up");
    }
    void vertices(const std::vector<Vec3>& positions) {
        vertices_ = positions.size();
        for (std::size_t i = 0; i < positions.size(); ++i)
            if (!is_finite(positions[i]))
                refuse(shape_, "has a vertex that is not finite (number " + std::to_string(i + 1) + ")",
                       "repair the mesh or its transformation");
        if (std::any_of(positions.begin(), positions.end(), [](const Vec3& v) { return is_too_far(v); }))
            refuse(shape_, "has a coordinate beyond 1e18", "scale the scene down");
    }
    void per_vertex(const char* name, const auto& values) const {
        const std::string what(name);
        if (!values.empty() && values.size() != vertices_)
            refuse(shape_, "has " + what + "s for some vertices only", "repair the mesh");
        for (const auto& value : values)
            for (unsigned i = 0; i < value.dimensions(); ++i)
                if (!std::isfinite(value[static_cast<int>(i)]))
                    refuse(shape_, "has a " + what + " that is not finite", "repair the mesh");
    }
    void triangles(const std::vector<std::uint32_t>& indices) const {
        if (indices.size() % 3 != 0) refuse(shape_, "has indices that are no whole triangles", "repair the mesh");
        for (const std::uint32_t index : indices)
            if (index >= vertices_)
                refuse(shape_,
                       "uses vertex " + std::to_string(index + std::uint64_t{1}) + " of " + std::to_string(vertices_),
                       "repair the mesh");
    }
    void attributes(const auto&) const {}  // check_mesh_attributes() knows which are needed

  private:
    /// Remaining check of a mesh with valid indices: it must have triangles with area.
    void check_whole(Mesh& mesh) {
        if (const std::size_t dropped = drop_degenerate(mesh); dropped > 0)
            warnings_.push_back(
                {shape_.where, std::to_string(dropped) + " triangles of " +
                                   (shape_.name.empty() ? "the shape" : "shape \"" + shape_.name + "\"") +
                                   " have no area and were left out"});
        if (mesh.indices.empty()) refuse(shape_, "has no triangles", "repair or remove it");
    }
    /// Remaining check of an instance: the shapes it places must stay within the range of coordinates.
    void check_whole(const Instance& instance) const {
        const Box3& box = groups_[static_cast<std::size_t>(instance.group)];
        for (int corner = 0; corner < 8; ++corner)
            point("place", Vec3(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                corner & 4 ? box.max.z : box.min.z) *
                               instance.to_world);
    }
    /// Remaining check of an analytic shape: its surface must stay within the range of coordinates.
    void check_whole(const auto& analytic) const {
        const Box3 box = analytic.box();
        if (is_too_far(box.min) || is_too_far(box.max))
            refuse(shape_, "has a coordinate beyond 1e18", "scale the scene down");
    }

    Shape& shape_;
    const std::vector<Box3>& groups_;
    std::vector<Warning>& warnings_;
    std::size_t vertices_ = 0;  ///< of the mesh being checked
};

void check_links(const Shape& shape, std::size_t index, const Scene& scene) {
    if (std::holds_alternative<Instance>(shape.geometry)) {
        if (shape.group != kNone) refuse(shape, "is an instance within a group", "place the inner shapes directly");
        if (shape.material != kNone || shape.emitter != kNone)
            refuse(shape, "is an instance with a material or an emitter of its own", "give them to the group's shapes");
        return;
    }
    if (shape.material < 0 || static_cast<std::size_t>(shape.material) >= scene.materials.size())
        refuse(shape, "has no material", "give it a bsdf");
    if (shape.emitter == kNone) return;
    if (shape.group != kNone) refuse(shape, "emits light within a group", "take it out of the group");
    const auto emitter = static_cast<std::size_t>(shape.emitter);
    if (emitter >= scene.emitters.size() || shape_of(scene.emitters[emitter]) != static_cast<std::int32_t>(index))
        refuse(shape, "and its emitter do not belong together", "give it an area emitter");
}

}  // namespace

bool is_flat(const Mesh& mesh) {
    if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), [](const Vec3& p) { return is_finite(p); }))
        return false;
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i)
        if (!without_area(mesh, i)) return false;
    return true;
}

bool lacks_tangents(const Scene& scene, const Shape& shape) {
    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
    return mesh && mesh->uvs.empty() && mesh->triangle_count() > 1 && shape.material >= 0 &&
           static_cast<std::size_t>(shape.material) < scene.materials.size() &&
           material_traits(scene, shape.material).anisotropic;
}

void check_shapes(Scene& scene, std::vector<Warning>& warnings) {
    if (scene.group_count < 0 || static_cast<std::size_t>(scene.group_count) > scene.shapes.size())
        throw InputError(Location{}, "the scene has more groups than shapes", "");
    std::vector<Box3> groups(static_cast<std::size_t>(scene.group_count));
    // Instances come last: they need the boxes of the shapes that they place.
    for (const bool instances : {false, true})
        for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
            Shape& shape = scene.shapes[i];
            if (std::holds_alternative<Instance>(shape.geometry) != instances) continue;
            if (shape.group != kNone && (shape.group < 0 || shape.group >= scene.group_count))
                refuse(shape, "belongs to a group that does not exist", "");
            check_links(shape, i, scene);
            if (lacks_tangents(scene, shape))
                warnings.push_back({shape.where, (shape.name.empty() ? "the shape" : "shape \"" + shape.name + "\"") +
                                                     " is anisotropic, but its mesh has no texture coordinates: "
                                                     "highlights follow the edges of its triangles"});
            ShapeCheck(shape, groups, warnings).run();
            if (shape.group != kNone) groups[static_cast<std::size_t>(shape.group)].extendBy(own_box(shape));
        }
}

}  // namespace treefarm::validation
