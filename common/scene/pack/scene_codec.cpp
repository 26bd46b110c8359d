// SPDX-License-Identifier: Apache-2.0
#include "common/scene/pack/scene_codec.h"

#include <cmath>

#include "common/base/hash.h"
#include "common/scene/pack/emitter_codec.h"
#include "common/scene/pack/material_codec.h"
#include "common/scene/pack/packed_values.h"
#include "common/scene/pack/shape_codec.h"
#include "common/scene/pack/texture_codec.h"
#include "common/scene/uses/emitter_uses.h"

namespace treefarm {
namespace {

using namespace packed;

constexpr std::uint32_t kMagic = 0x43534654;  // "TFSC"
constexpr std::uint32_t kVersion = 9;

/// Calls f for each origin of a part: f(std::string& file) for images, f(Location&) for others.
template <class AnyScene, class F>
void for_each_origin(AnyScene& scene, F&& f) {
    for (auto& image : scene.images)
        f(image.name);
    for (auto& texture : scene.textures)
        f(texture.where);
    for (auto& material : scene.materials)
        f(material.where);
    for (auto& shape : scene.shapes)
        f(shape.where);
    for (auto& emitter : scene.emitters)
        f(emitter.where);
}

struct PutOrigins {
    ByteWriter& out;
    void operator()(const std::string& file) const { out.put_string(file); }
    void operator()(const Location& where) const { put_location(out, where); }
};

struct GetOrigins {
    ByteReader& in;
    void operator()(std::string& file) const { file = in.get_string(); }
    void operator()(Location& where) const { where = get_location(in); }
};

Camera get_camera(ByteReader& in) {
    Camera camera;
    for (Vec3* v : {&camera.origin, &camera.corner, &camera.across, &camera.down, &camera.lens_u, &camera.lens_v,
                    &camera.parallel})
        *v = get_vector<Vec3>(in);
    camera.panoramic = get_flag(in, "panoramic camera");
    camera.passes_hidden_emitters = get_flag(in, "transparency of hidden emitters");
    return camera;
}

void put_film(ByteWriter& out, const Film& film) {
    out.put<std::int32_t>(film.width);
    out.put<std::int32_t>(film.height);
    put_enum(out, film.filter);
    out.put(film.filter_radius);
    out.put(film.filter_stddev);
    out.put(film.filter_b);
    out.put(film.filter_c);
    for (const int number : {film.crop.x, film.crop.y, film.crop.whole_width, film.crop.whole_height})
        out.put<std::int32_t>(number);
}

Film get_film(ByteReader& in) {
    Film film;
    film.width = in.get<std::int32_t>();
    film.height = in.get<std::int32_t>();
    if (film.width < 1 || film.height < 1 || film.width > 65535 || film.height > 65535)
        throw FormatError("scene: a film of " + std::to_string(film.width) + " x " + std::to_string(film.height));
    film.filter = get_enum(in, PixelFilter::lanczos, "pixel filter");
    film.filter_radius = in.get<float>();
    film.filter_stddev = in.get<float>();
    if (!(film.filter_radius > 0.0f) || !(film.filter_stddev > 0.0f) || !std::isfinite(film.filter_radius) ||
        !std::isfinite(film.filter_stddev))
        throw FormatError("scene: the pixel filter's size is not positive");
    film.filter_b = in.get<float>();
    film.filter_c = in.get<float>();
    if (!std::isfinite(film.filter_b) || !std::isfinite(film.filter_c))
        throw FormatError("scene: the pixel filter's B and C are not finite");
    for (int* number : {&film.crop.x, &film.crop.y, &film.crop.whole_width, &film.crop.whole_height})
        *number = in.get<std::int32_t>();
    if (!film.is_crop_valid()) throw FormatError("scene: a crop window that is not on its film");
    return film;
}

/// Throws FormatError unless shapes and their area emitters refer to each other.
void check_area_emitters(const Scene& scene) {
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const std::int32_t index = scene.shapes[i].emitter;
        if (index == kNone) continue;
        if (index < 0 || static_cast<std::size_t>(index) >= scene.emitters.size())
            throw FormatError("scene: emitter " + std::to_string(index) + " of " +
                              std::to_string(scene.emitters.size()));
        if (shape_of(scene.emitters[static_cast<std::size_t>(index)]) != static_cast<std::int32_t>(i))
            throw FormatError("scene: shape " + std::to_string(i) + " and its emitter disagree");
    }
    for (std::size_t i = 0; i < scene.emitters.size(); ++i)
        if (const std::int32_t shape = shape_of(scene.emitters[i]); shape != kNone)
            if (scene.shapes[static_cast<std::size_t>(shape)].emitter != static_cast<std::int32_t>(i))
                throw FormatError("scene: emitter " + std::to_string(i) + " and its shape disagree");
}

void check_environments(const Scene& scene) {
    std::size_t count = 0;
    for (const Emitter& emitter : scene.emitters) {
        for_each_image(emitter, [&](std::int32_t image) {
            if (scene.images[static_cast<std::size_t>(image)].channels != 3)
                throw FormatError("scene: an emitter's image has no three channels");
        });
        if (emitter.type() == LightType::environment && ++count > 1) throw FormatError("scene: a second environment");
    }
}

/// Visitor that adds up the bytes of a mesh's arrays.
struct ArrayBytes : IgnoreFields {
    std::size_t bytes = 0;
    void vertices(const std::vector<Vec3>& list) { bytes += list.size() * sizeof(Vec3); }
    void triangles(const std::vector<std::uint32_t>& list) { bytes += list.size() * sizeof(std::uint32_t); }
    template <class V>
    void per_vertex(const char*, const std::vector<V>& list) {
        bytes += list.size() * sizeof(V);
    }
};

/// Bytes of the arrays of all meshes: most of a large scene.
std::size_t array_bytes(const Scene& scene) {
    ArrayBytes arrays;
    for (const Shape& shape : scene.shapes)
        visit_fields(shape.geometry, arrays);
    return arrays.bytes;
}

}  // namespace

Bytes encode_scene(const Scene& scene) {
    ByteWriter out;
    out.put(kMagic);
    out.put(kVersion);
    put_list(out, scene.images, put_image);
    put_list(out, scene.textures, put_texture);
    put_list(out, scene.materials, put_material);
    out.put(static_cast<std::uint32_t>(scene.group_count));
    out.reserve(array_bytes(scene));  // once, so that written bytes are not copied while it grows
    put_list(out, scene.shapes, put_shape);
    put_list(out, scene.emitters, put_emitter);
    const Camera& camera = scene.camera;
    for (const Vec3& v :
         {camera.origin, camera.corner, camera.across, camera.down, camera.lens_u, camera.lens_v, camera.parallel})
        put_vector(out, v);
    out.put<std::uint8_t>(camera.panoramic);
    out.put<std::uint8_t>(camera.passes_hidden_emitters);
    put_film(out, scene.film);
    const std::uint64_t content = out.size();
    for_each_origin(scene, PutOrigins{out});
    out.put(content);
    return out.take();
}

std::uint64_t content_hash(std::span<const std::uint8_t> packed) {
    ByteReader end(packed.last(sizeof(std::uint64_t)));
    return hash_bytes(packed.first(static_cast<std::size_t>(end.get<std::uint64_t>())));
}

Scene decode_scene(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    if (in.get<std::uint32_t>() != kMagic) throw FormatError("scene: this is not a packed scene");
    if (const auto version = in.get<std::uint32_t>(); version != kVersion)
        throw FormatError("scene: packed by version " + std::to_string(version) + ", this program reads version " +
                          std::to_string(kVersion));
    Scene scene;
    get_list(in, kMinImageBytes, scene.images, [&] { return get_image(in); });
    get_list(in, kMinTextureBytes, scene.textures, [&] { return get_texture(in, scene.images.size()); });
    get_list(in, kMinMaterialBytes, scene.materials,
             [&] { return get_material(in, scene.materials.size(), scene.textures.size()); });
    // Each group has a shape, so a false count cannot cause a large allocation.
    const std::size_t group_count = in.get<std::uint32_t>();
    if (group_count > in.remaining() / kMinShapeBytes)
        throw FormatError("scene: " + std::to_string(group_count) + " groups do not fit into what remains");
    scene.group_count = static_cast<std::int32_t>(group_count);
    get_list(in, kMinShapeBytes, scene.shapes, [&] { return get_shape(in, scene.materials.size(), group_count); });
    if (group_count > scene.shapes.size())
        throw FormatError("scene: " + std::to_string(group_count) + " groups of " +
                          std::to_string(scene.shapes.size()) + " shapes");
    const PackedCounts counts{0, scene.textures.size(), scene.images.size(), scene.shapes.size()};
    get_list(in, kMinEmitterBytes, scene.emitters, [&] { return get_emitter(in, counts); });
    check_area_emitters(scene);
    check_environments(scene);
    scene.camera = get_camera(in);
    scene.film = get_film(in);
    const std::uint64_t content = bytes.size() - in.remaining();
    for_each_origin(scene, GetOrigins{in});
    if (const auto said = in.get<std::uint64_t>(); said != content)
        throw FormatError("scene: its content has " + std::to_string(content) + " bytes, not " + std::to_string(said));
    in.expect_end();
    return scene;
}

}  // namespace treefarm
