#include "common/scene/validate.h"

#include <algorithm>
#include <cmath>

namespace treefarm {
namespace {

bool finite(const Vec3& v) {
    return is_finite(v);
}

/// Embree silently leaves out what lies beyond 1.8e18, and squared distances must stay floats.
constexpr float kFarthest = 1e18f;

bool too_far(const Vec3& v, float margin = 0.0f) {
    return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z))) + margin > kFarthest;
}

/// "shape "lamp"", or "the shape" if it has no name.
std::string shape_name(const Shape& shape) {
    return shape.name.empty() ? "the shape" : "shape \"" + shape.name + "\"";
}

/// Twice the triangle's area is zero (or too small for single precision to give it a normal).
bool without_area(const Mesh& mesh, std::size_t triangle) {
    const Vec3& a = mesh.positions[mesh.indices[3 * triangle]];
    const Vec3& b = mesh.positions[mesh.indices[3 * triangle + 1]];
    const Vec3& c = mesh.positions[mesh.indices[3 * triangle + 2]];
    const Vec3 normal = cross(b - a, c - a);
    const float squared = dot(normal, normal);
    return !(squared > 0.0f) || !std::isfinite(1.0f / std::sqrt(squared));
}

/// Removes triangles without area; returns how many.
std::size_t drop_degenerate(Mesh& mesh) {
    const std::size_t count = mesh.triangle_count();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (without_area(mesh, i)) continue;
        for (std::size_t k = 0; k < 3; ++k)
            mesh.indices[3 * kept + k] = mesh.indices[3 * i + k];
        ++kept;
    }
    mesh.indices.resize(3 * kept);
    return count - kept;
}

void validate_mesh(Mesh& mesh, const Shape& shape, std::vector<Warning>& warnings) {
    const std::string name = shape_name(shape);
    if (mesh.indices.size() % 3 != 0)
        throw InputError(shape.where, name + " has indices that are no whole triangles", "");
    for (const std::uint32_t index : mesh.indices)
        if (index >= mesh.positions.size())
            throw InputError(shape.where,
                             name + " uses vertex " + std::to_string(index + std::uint64_t{1}) + " of " +
                                 std::to_string(mesh.positions.size()),
                             "repair the mesh");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (!finite(mesh.positions[i]))
            throw InputError(shape.where,
                             name + " has a vertex that is not finite (number " + std::to_string(i + 1) + ")",
                             "repair the mesh or its transformation");
    if (std::any_of(mesh.positions.begin(), mesh.positions.end(), [](const Vec3& v) { return too_far(v); }))
        throw InputError(shape.where, name + " has a coordinate beyond 1e18", "scale the scene down");
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        throw InputError(shape.where, name + " has normals for some vertices only", "repair the mesh");
    if (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size())
        throw InputError(shape.where, name + " has texture coordinates for some vertices only", "repair the mesh");
    for (const Vec3& normal : mesh.normals)
        if (!finite(normal))
            throw InputError(shape.where, name + " has a normal that is not finite", "repair the mesh");
    for (const Vec2& uv : mesh.uvs)
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
            throw InputError(shape.where, name + " has a texture coordinate that is not finite", "repair the mesh");
    if (const std::size_t dropped = drop_degenerate(mesh); dropped > 0)
        warnings.push_back(
            {shape.where, std::to_string(dropped) + " triangles of " + name + " have no area and were left out"});
    if (mesh.indices.empty()) throw InputError(shape.where, name + " has no triangles", "repair or remove it");
}

void validate_shape(Shape& shape, std::size_t index, const Scene& scene, std::vector<Warning>& warnings) {
    if (auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
        validate_mesh(*mesh, shape, warnings);
    } else if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
        if (!finite(sphere->center) || !std::isfinite(sphere->radius))
            throw InputError(shape.where, shape_name(shape) + " is not finite",
                             "check its centre, radius and transformation");
        if (sphere->radius <= 0.0f)
            throw InputError(shape.where, shape_name(shape) + " has a radius that is not positive",
                             "give a positive radius");
        if (too_far(sphere->center, sphere->radius))
            throw InputError(shape.where, shape_name(shape) + " has a coordinate beyond 1e18", "scale the scene down");
    }
    if (shape.material < 0 || static_cast<std::size_t>(shape.material) >= scene.materials.size())
        throw InputError(shape.where, shape_name(shape) + " has no material", "give it a bsdf");
    if (shape.emitter == kNone) return;
    const auto emitter = static_cast<std::size_t>(shape.emitter);
    const auto* area =
        emitter < scene.emitters.size() ? std::get_if<AreaEmitter>(&scene.emitters[emitter].kind) : nullptr;
    if (area == nullptr || area->shape != static_cast<std::int32_t>(index))
        throw InputError(shape.where, shape_name(shape) + " and its emitter do not belong together",
                         "give it an area emitter");
}

void validate_radiance(const Rgb& radiance, const Location& where) {
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(radiance[i]) || radiance[i] < 0.0f)
            throw InputError(where, "the emitter's radiance is negative or not finite", "give values of 0 or more");
}

void validate_film(const Film& film) {
    if (film.width < 1 || film.width > 65535 || film.height < 1 || film.height > 65535)
        throw InputError(Location{},
                         "the film has " + std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels",
                         "give a width and a height of 1 to 65535");
    if (!std::isfinite(film.filter_radius) || film.filter_radius <= 0.0f || !std::isfinite(film.filter_stddev) ||
        film.filter_stddev <= 0.0f)
        throw InputError(Location{}, "the pixel filter's size is not positive", "give a positive radius or stddev");
}

}  // namespace

void validate_scene(Scene& scene, std::vector<Warning>& warnings) {
    for (const Material& material : scene.materials) {
        const auto* diffuse = std::get_if<DiffuseMaterial>(&material.bsdf);
        if (diffuse == nullptr) continue;
        const Rgb& reflectance = diffuse->reflectance.value;
        for (int i = 0; i < 3; ++i)
            if (!(reflectance[i] >= 0.0f && reflectance[i] <= 1.0f))
                throw InputError(material.where, "the reflectance is outside 0 to 1", "give values from 0 to 1");
    }
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        validate_shape(scene.shapes[i], i, scene, warnings);
    std::size_t environments = 0;
    for (const Emitter& emitter : scene.emitters) {
        if (const auto* area = std::get_if<AreaEmitter>(&emitter.kind)) {
            validate_radiance(area->radiance.value, emitter.where);
            if (area->shape < 0 || static_cast<std::size_t>(area->shape) >= scene.shapes.size())
                throw InputError(emitter.where, "the area emitter has no shape", "put it into a shape");
        } else if (const auto* constant = std::get_if<ConstantEmitter>(&emitter.kind)) {
            validate_radiance(constant->radiance, emitter.where);
            if (++environments > 1)
                throw InputError(emitter.where, "this is a second environment emitter", "keep one of them");
        }
    }
    validate_film(scene.film);
    const Camera& camera = scene.camera;
    if (!finite(camera.origin) || !finite(camera.corner) || !finite(camera.across) || !finite(camera.down))
        throw InputError(Location{}, "the camera is not finite", "check the sensor's transformation and field of view");

    if (scene.shapes.empty()) warnings.push_back(Warning{Location{}, "the scene has no shapes"});
    if (scene.emitters.empty()) warnings.push_back(Warning{Location{}, "the scene has no emitters: it renders black"});
}

}  // namespace treefarm
