#include "common/scene/scene_codec.h"

#include <cmath>

namespace treefarm {
namespace {

constexpr std::uint32_t kMagic = 0x43534654;  // "TFSC"
constexpr std::uint32_t kVersion = 1;

enum class GeometryKind : std::uint8_t { mesh, sphere };
enum class MaterialKind : std::uint8_t { diffuse };
enum class EmitterKind : std::uint8_t { area, constant };

template <class V>
void put_vector(ByteWriter& out, const V& v) {
    for (unsigned i = 0; i < V::dimensions(); ++i)
        out.put(v[static_cast<int>(i)]);
}

template <class V>
void put_vectors(ByteWriter& out, const std::vector<V>& values) {
    out.put_varint(values.size());
    for (const V& v : values)
        put_vector(out, v);
}

void put_location(ByteWriter& out, const Location& where) {
    out.put_string(where.file);
    out.put<std::int32_t>(where.line);
    out.put<std::int32_t>(where.column);
}

template <class V>
V get_vector(ByteReader& in) {
    V v;
    for (unsigned i = 0; i < V::dimensions(); ++i)
        v[static_cast<int>(i)] = in.get<float>();
    return v;
}

template <class V>
std::vector<V> get_vectors(ByteReader& in) {
    const std::size_t count = in.get_count(V::dimensions() * sizeof(float));
    std::vector<V> values(count);
    for (V& v : values)
        v = get_vector<V>(in);
    return values;
}

Location get_location(ByteReader& in) {
    Location where;
    where.file = in.get_string();
    where.line = in.get<std::int32_t>();
    where.column = in.get<std::int32_t>();
    return where;
}

bool get_flag(ByteReader& in, const char* what) {
    const auto flag = in.get<std::uint8_t>();
    if (flag > 1) throw FormatError(std::string("scene: ") + what + " is neither 0 nor 1");
    return flag == 1;
}

/// An index below `count`, or kNone where that is allowed.
std::int32_t get_index(ByteReader& in, std::size_t count, bool optional, const char* what) {
    const auto index = in.get<std::int32_t>();
    if (index == kNone && optional) return index;
    if (index < 0 || static_cast<std::size_t>(index) >= count)
        throw FormatError(std::string("scene: ") + what + " " + std::to_string(index) + " of " + std::to_string(count));
    return index;
}

void put_shape(ByteWriter& out, const Shape& shape) {
    if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
        out.put(static_cast<std::uint8_t>(GeometryKind::mesh));
        put_vectors(out, mesh->positions);
        put_vectors(out, mesh->normals);
        put_vectors(out, mesh->uvs);
        out.put_array(std::span<const std::uint32_t>(mesh->indices));
    } else {
        const auto& sphere = std::get<Sphere>(shape.geometry);
        out.put(static_cast<std::uint8_t>(GeometryKind::sphere));
        put_vector(out, sphere.center);
        out.put(sphere.radius);
        out.put<std::uint8_t>(sphere.flip_normals ? 1 : 0);
    }
    out.put(shape.material);
    out.put(shape.emitter);
    out.put_string(shape.name);
    put_location(out, shape.where);
}

Mesh get_mesh(ByteReader& in) {
    Mesh mesh;
    mesh.positions = get_vectors<Vec3>(in);
    mesh.normals = get_vectors<Vec3>(in);
    mesh.uvs = get_vectors<Vec2>(in);
    mesh.indices = in.get_array<std::uint32_t>();
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        throw FormatError("scene: a mesh has " + std::to_string(mesh.normals.size()) + " normals for " +
                          std::to_string(mesh.positions.size()) + " positions");
    if (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size())
        throw FormatError("scene: a mesh has " + std::to_string(mesh.uvs.size()) + " texture coordinates for " +
                          std::to_string(mesh.positions.size()) + " positions");
    if (mesh.indices.size() % 3 != 0) throw FormatError("scene: a mesh's indices are no whole triangles");
    for (const std::uint32_t index : mesh.indices)
        if (index >= mesh.positions.size())
            throw FormatError("scene: vertex " + std::to_string(index) + " of " +
                              std::to_string(mesh.positions.size()));
    return mesh;
}

Shape get_shape(ByteReader& in, std::size_t material_count) {
    Shape shape;
    switch (const auto kind = in.get<std::uint8_t>(); static_cast<GeometryKind>(kind)) {
        case GeometryKind::mesh:
            shape.geometry = get_mesh(in);
            break;
        case GeometryKind::sphere: {
            Sphere sphere;
            sphere.center = get_vector<Vec3>(in);
            sphere.radius = in.get<float>();
            sphere.flip_normals = get_flag(in, "a sphere's flip");
            shape.geometry = sphere;
            break;
        }
        default:
            throw FormatError("scene: unknown kind of shape " + std::to_string(kind));
    }
    shape.material = get_index(in, material_count, true, "material");
    shape.emitter = in.get<std::int32_t>();  // checked when the emitters are known
    shape.name = in.get_string();
    shape.where = get_location(in);
    return shape;
}

void put_emitter(ByteWriter& out, const Emitter& emitter) {
    if (const auto* area = std::get_if<AreaEmitter>(&emitter.kind)) {
        out.put(static_cast<std::uint8_t>(EmitterKind::area));
        put_vector(out, area->radiance.value);
        out.put(area->shape);
    } else {
        out.put(static_cast<std::uint8_t>(EmitterKind::constant));
        put_vector(out, std::get<ConstantEmitter>(emitter.kind).radiance);
        out.put(kNone);
    }
    put_location(out, emitter.where);
}

Emitter get_emitter(ByteReader& in, const std::vector<Shape>& shapes) {
    Emitter emitter;
    const auto kind = in.get<std::uint8_t>();
    const Rgb radiance = get_vector<Rgb>(in);
    switch (static_cast<EmitterKind>(kind)) {
        case EmitterKind::area:
            emitter.kind = AreaEmitter{radiance, get_index(in, shapes.size(), false, "emitting shape")};
            break;
        case EmitterKind::constant:
            emitter.kind = ConstantEmitter{radiance};
            if (in.get<std::int32_t>() != kNone) throw FormatError("scene: a constant emitter has a shape");
            break;
        default:
            throw FormatError("scene: unknown kind of emitter " + std::to_string(kind));
    }
    emitter.where = get_location(in);
    return emitter;
}

Film get_film(ByteReader& in) {
    Film film;
    film.width = in.get<std::int32_t>();
    film.height = in.get<std::int32_t>();
    if (film.width < 1 || film.height < 1 || film.width > 65535 || film.height > 65535)
        throw FormatError("scene: a film of " + std::to_string(film.width) + " x " + std::to_string(film.height));
    const auto filter = in.get<std::uint8_t>();
    if (filter > static_cast<std::uint8_t>(PixelFilter::gaussian))
        throw FormatError("scene: unknown pixel filter " + std::to_string(filter));
    film.filter = static_cast<PixelFilter>(filter);
    film.filter_radius = in.get<float>();
    film.filter_stddev = in.get<float>();
    if (!(film.filter_radius > 0.0f) || !(film.filter_stddev > 0.0f) || !std::isfinite(film.filter_radius) ||
        !std::isfinite(film.filter_stddev))
        throw FormatError("scene: the pixel filter's size is not positive");
    return film;
}

void check_emitters(const Scene& scene) {
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const std::int32_t index = scene.shapes[i].emitter;
        if (index == kNone) continue;
        if (index < 0 || static_cast<std::size_t>(index) >= scene.emitters.size())
            throw FormatError("scene: emitter " + std::to_string(index) + " of " +
                              std::to_string(scene.emitters.size()));
        const auto* area = std::get_if<AreaEmitter>(&scene.emitters[static_cast<std::size_t>(index)].kind);
        if (area == nullptr || area->shape != static_cast<std::int32_t>(i))
            throw FormatError("scene: shape " + std::to_string(i) + " and its emitter disagree");
    }
    for (std::size_t i = 0; i < scene.emitters.size(); ++i)
        if (const auto* area = std::get_if<AreaEmitter>(&scene.emitters[i].kind))
            if (scene.shapes[static_cast<std::size_t>(area->shape)].emitter != static_cast<std::int32_t>(i))
                throw FormatError("scene: emitter " + std::to_string(i) + " and its shape disagree");
}

}  // namespace

Bytes encode_scene(const Scene& scene) {
    ByteWriter out;
    out.put(kMagic);
    out.put(kVersion);
    out.put_varint(scene.materials.size());
    for (const Material& material : scene.materials) {
        out.put(static_cast<std::uint8_t>(MaterialKind::diffuse));
        put_vector(out, std::get<DiffuseMaterial>(material.bsdf).reflectance.value);
        out.put<std::uint8_t>(material.twosided ? 1 : 0);
        out.put_string(material.name);
        put_location(out, material.where);
    }
    out.put_varint(scene.shapes.size());
    for (const Shape& shape : scene.shapes)
        put_shape(out, shape);
    out.put_varint(scene.emitters.size());
    for (const Emitter& emitter : scene.emitters)
        put_emitter(out, emitter);
    for (const Vec3& v : {scene.camera.origin, scene.camera.corner, scene.camera.across, scene.camera.down})
        put_vector(out, v);
    out.put<std::int32_t>(scene.film.width);
    out.put<std::int32_t>(scene.film.height);
    out.put(static_cast<std::uint8_t>(scene.film.filter));
    out.put(scene.film.filter_radius);
    out.put(scene.film.filter_stddev);
    return out.take();
}

Scene decode_scene(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    if (in.get<std::uint32_t>() != kMagic) throw FormatError("scene: this is not a packed scene");
    if (const auto version = in.get<std::uint32_t>(); version != kVersion)
        throw FormatError("scene: packed by version " + std::to_string(version) + ", this program reads version " +
                          std::to_string(kVersion));
    Scene scene;
    // The smallest material, shape and emitter take 24, 23 and 26 bytes.
    const std::size_t material_count = in.get_count(24);
    scene.materials.reserve(material_count);
    for (std::size_t i = 0; i < material_count; ++i) {
        Material material;
        if (const auto kind = in.get<std::uint8_t>(); kind != static_cast<std::uint8_t>(MaterialKind::diffuse))
            throw FormatError("scene: unknown kind of material " + std::to_string(kind));
        material.bsdf = DiffuseMaterial{get_vector<Rgb>(in)};
        material.twosided = get_flag(in, "twosided");
        material.name = in.get_string();
        material.where = get_location(in);
        scene.materials.push_back(std::move(material));
    }
    const std::size_t shape_count = in.get_count(23);
    scene.shapes.reserve(shape_count);
    for (std::size_t i = 0; i < shape_count; ++i)
        scene.shapes.push_back(get_shape(in, material_count));
    const std::size_t emitter_count = in.get_count(26);
    scene.emitters.reserve(emitter_count);
    for (std::size_t i = 0; i < emitter_count; ++i)
        scene.emitters.push_back(get_emitter(in, scene.shapes));
    check_emitters(scene);
    scene.camera.origin = get_vector<Vec3>(in);
    scene.camera.corner = get_vector<Vec3>(in);
    scene.camera.across = get_vector<Vec3>(in);
    scene.camera.down = get_vector<Vec3>(in);
    scene.film = get_film(in);
    in.expect_end();
    return scene;
}

}  // namespace treefarm
