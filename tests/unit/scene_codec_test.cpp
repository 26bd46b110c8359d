#include "common/scene/scene_codec.h"

#include <gtest/gtest.h>

#include "common/scene/load.h"
#include "tests/support/support.h"

namespace treefarm {
namespace {

Scene example() {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[0].bsdf = DiffuseMaterial{Rgb(0.1f, 0.2f, 0.3f)};
    scene.materials[0].twosided = true;
    scene.materials[0].name = "paint";
    scene.materials[0].where = {"a.xml", 1, 2};
    Mesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    mesh.normals = {Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 1)};
    mesh.uvs = {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
    mesh.indices = {0, 1, 2};
    scene.shapes.push_back({mesh, 1, 0, kNone, "lamp", {"b.xml", 3, 4}});
    scene.shapes.push_back({Sphere{Vec3(1, 2, 3), 4.0f, true}, 0, kNone, kNone, "", {}});
    scene.emitters.push_back({AreaEmitter{Rgb(1, 2, 3), 0}, {"b.xml", 5, 6}});
    scene.emitters.push_back({ConstantEmitter{Rgb(4, 5, 6)}, {}});
    scene.camera = {Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9), Vec3(10, 11, 12), {}, {}};
    scene.film = {65535, 1, PixelFilter::gaussian, 2.0f, 0.5f};
    return scene;
}

TEST(SceneCodec, RoundTrip) {
    const Bytes bytes = encode_scene(example());
    const Scene back = decode_scene(bytes);
    EXPECT_EQ(encode_scene(back), bytes);
    EXPECT_EQ(back.materials[0].name, "paint");
    EXPECT_EQ(back.materials[0].where.text(), "a.xml:1:2");
    EXPECT_TRUE(back.materials[0].twosided);
    EXPECT_EQ(std::get<DiffuseMaterial>(back.materials[0].bsdf).reflectance, Rgb(0.1f, 0.2f, 0.3f));
    const auto& mesh = std::get<Mesh>(back.shapes[0].geometry);
    EXPECT_EQ(mesh.positions[2], Vec3(0, 1, 0));
    EXPECT_EQ(mesh.uvs[1], Vec2(1, 0));
    EXPECT_EQ(back.shapes[0].material, 1);
    EXPECT_EQ(back.shapes[0].where.text(), "b.xml:3:4");
    EXPECT_TRUE(std::get<Sphere>(back.shapes[1].geometry).flip_normals);
    EXPECT_EQ(std::get<AreaEmitter>(back.emitters[0].kind).radiance, Rgb(1, 2, 3));
    EXPECT_EQ(std::get<ConstantEmitter>(back.emitters[1].kind).radiance, Rgb(4, 5, 6));
    EXPECT_EQ(back.camera.down, Vec3(10, 11, 12));
    EXPECT_EQ(back.film.width, 65535);
    EXPECT_EQ(back.film.filter, PixelFilter::gaussian);
}

TEST(SceneCodec, EmptySceneRoundTrip) {
    const Bytes bytes = encode_scene(Scene{});
    EXPECT_EQ(encode_scene(decode_scene(bytes)), bytes);
}

TEST(SceneCodec, EveryCutIsRefused) {
    const Bytes bytes = encode_scene(example());
    for (std::size_t n = 0; n < bytes.size(); ++n)
        EXPECT_THROW(decode_scene(std::span(bytes).first(n)), FormatError) << n;
    Bytes longer = bytes;
    longer.push_back(0);
    EXPECT_THROW(decode_scene(longer), FormatError);
}

TEST(SceneCodec, EveryFlippedByteIsRefusedOrReadable) {
    const Bytes bytes = encode_scene(example());
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (const int flip : {0x01, 0x80, 0xff}) {
            Bytes damaged = bytes;
            damaged[i] = static_cast<std::uint8_t>(damaged[i] ^ flip);
            try {
                const Scene scene = decode_scene(damaged);
                for (const Shape& shape : scene.shapes) {
                    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
                    if (mesh == nullptr) continue;
                    for (const std::uint32_t index : mesh->indices)
                        EXPECT_LT(index, mesh->positions.size());
                }
            } catch (const FormatError&) {
            }
        }
}

TEST(SceneCodec, IndicesAreChecked) {
    const auto refused = [](auto change) {
        Scene scene = example();
        change(scene);
        EXPECT_THROW(decode_scene(encode_scene(scene)), FormatError);
    };
    refused([](Scene& s) { std::get<Mesh>(s.shapes[0].geometry).indices[1] = 3; });
    refused([](Scene& s) { std::get<Mesh>(s.shapes[0].geometry).indices.push_back(0); });
    refused([](Scene& s) { std::get<Mesh>(s.shapes[0].geometry).normals.pop_back(); });
    refused([](Scene& s) { std::get<Mesh>(s.shapes[0].geometry).uvs.pop_back(); });
    refused([](Scene& s) { s.shapes[0].material = 2; });
    refused([](Scene& s) { s.shapes[0].material = -2; });
    refused([](Scene& s) { s.shapes[0].emitter = 1; });
    refused([](Scene& s) { s.shapes[0].emitter = 2; });
    refused([](Scene& s) { s.shapes[0].emitter = kNone; });
    refused([](Scene& s) { std::get<AreaEmitter>(s.emitters[0].kind).shape = 1; });
    refused([](Scene& s) { std::get<AreaEmitter>(s.emitters[0].kind).shape = kNone; });
    refused([](Scene& s) { s.film.width = 0; });
    refused([](Scene& s) { s.film.height = 65536; });
    refused([](Scene& s) { s.film.filter_stddev = -1.0f; });
}

TEST(SceneCodec, OwnScenesTravel) {
    for (const char* name : {"cornell-box.xml", "white-furnace.xml", "door-ajar.xml"}) {
        const Bytes bytes = encode_scene(load_scene(test::own_scene(name)).scene);
        EXPECT_EQ(encode_scene(decode_scene(bytes)), bytes) << name;
    }
}

}  // namespace
}  // namespace treefarm
