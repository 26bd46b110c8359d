// SPDX-License-Identifier: Apache-2.0
#include "common/scene/pack/scene_codec.h"

#include <gtest/gtest.h>

#include "coordinator/input/load.h"
#include "tests/support/every_kind.h"
#include "tests/support/kind_scenes.h"
#include "tests/support/support.h"

namespace treefarm {
namespace {

Scene example() {
    return test::every_kind_scene();
}

/// Indices of the alternatives that a list of variants does not hold.
template <class Kinds, class List, class F>
std::vector<std::size_t> missing_kinds(const List& list, F&& kind_of) {
    std::vector<bool> held(std::variant_size_v<Kinds>);
    for (const auto& item : list)
        held[kind_of(item).index()] = true;
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < held.size(); ++i)
        if (!held[i]) missing.push_back(i);
    return missing;
}

TEST(SceneCodec, TheExampleHoldsEveryKind) {
    const Scene scene = example();
    const std::vector<std::size_t> none;
    EXPECT_EQ(missing_kinds<MaterialKind>(
                  scene.materials, [](const Material& m) -> auto& { return m.bsdf; }),
              none);
    std::vector<Emitter> emitters = scene.emitters;
    for_each_kind<EmitterKind>([&]<class Kind>() {  // a scene has one environment at most
        if (Kind::kTraits.type == LightType::environment) emitters.push_back({Kind(), {}});
    });
    EXPECT_EQ(missing_kinds<EmitterKind>(
                  emitters, [](const Emitter& e) -> auto& { return e.kind; }),
              none);
    EXPECT_EQ(missing_kinds<TextureKind>(
                  scene.textures, [](const Texture& t) -> auto& { return t.kind; }),
              none);
    EXPECT_EQ(missing_kinds<ShapeKind>(
                  scene.shapes, [](const Shape& s) -> auto& { return s.geometry; }),
              none);
}

TEST(SceneCodec, RoundTrip) {
    const Bytes bytes = encode_scene(example());
    const Scene back = decode_scene(bytes);
    EXPECT_EQ(encode_scene(back), bytes);
    EXPECT_EQ(back.images[0].bytes[3], 192);
    EXPECT_EQ(back.images[0].decode[255], 1.0f);
    EXPECT_EQ(back.images[1].floats[3], 0.75f);
    EXPECT_EQ(back.images[1].height, 2);
    EXPECT_EQ(back.images[2].channels, 1);
    EXPECT_EQ(back.images[1].name, "sky.exr");
    const auto& bitmap = std::get<BitmapTexture>(back.textures[0].kind);
    EXPECT_FALSE(bitmap.bilinear);
    EXPECT_EQ(bitmap.wrap_u, Wrap::mirror);
    EXPECT_EQ(bitmap.wrap_v, Wrap::one);
    EXPECT_EQ(bitmap.uv, (UvTransform{Vec3(2, 0, 1), Vec3(0, 3, 4)}));
    EXPECT_EQ(back.textures[0].name, "wood");
    const auto& board = std::get<CheckerboardTexture>(back.textures[1].kind);
    EXPECT_EQ(board.color0, Rgb(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(board.color1, Rgb(1.0f));
    EXPECT_EQ(std::get<MeshAttributeTexture>(back.textures[3].kind).name, "vertex_color");
    const auto& attributes = std::get<Mesh>(back.shapes[4].geometry).attributes;
    ASSERT_EQ(attributes.size(), 2u);
    EXPECT_EQ(attributes[0].values, (std::vector<Rgb>{Rgb(0.5f, 0.25f, 0.125f), Rgb(0.75f), Rgb(0, 1, 0)}));
    EXPECT_EQ(attributes[1].name, "face_wear");
}

TEST(SceneCodec, AttributesMustFitTheirMesh) {
    Scene scene = example();
    std::get<Mesh>(scene.shapes[4].geometry).attributes[1].values.clear();
    EXPECT_THROW(decode_scene(encode_scene(scene)), FormatError);
    std::get<Mesh>(scene.shapes[4].geometry).attributes[1].values = {3, Rgb(0.5f)};
    EXPECT_THROW(decode_scene(encode_scene(scene)), FormatError);
}

TEST(SceneCodec, MaterialsRoundTrip) {
    const Scene back = decode_scene(encode_scene(example()));
    const Roughness rough{Microfacets::ggx, {0.25f}, {0.5f, 2}};
    EXPECT_EQ(std::get<DiffuseMaterial>(back.materials[0].bsdf).reflectance, ColorInput(Rgb(0.1f, 0.2f, 0.3f), 0));
    EXPECT_EQ(back.materials[0].where.text(), "a.xml:1:7");
    const auto& conductor = std::get<ConductorMaterial>(back.materials[1].bsdf);
    EXPECT_EQ(conductor.eta, Rgb(0.2f, 0.9f, 1.1f));
    EXPECT_EQ(conductor.k, Rgb(3.9f, 2.4f, 2.2f));
    EXPECT_EQ(conductor.roughness, rough);
    EXPECT_TRUE(back.materials[1].twosided);
    const auto& dielectric = std::get<DielectricMaterial>(back.materials[2].bsdf);
    EXPECT_EQ(dielectric.eta, 1.33f);
    EXPECT_EQ(dielectric.specular_reflectance, ColorInput(Rgb(0.9f)));
    EXPECT_EQ(dielectric.specular_transmittance, ColorInput(Rgb(0.8f), 1));
    EXPECT_EQ(back.materials[2].opacity, FloatInput(0.5f, 2));
    EXPECT_EQ(std::get<ThinDielectricMaterial>(back.materials[3].bsdf).specular_transmittance, ColorInput(Rgb(0.6f)));
    const auto& plastic = std::get<PlasticMaterial>(back.materials[4].bsdf);
    EXPECT_TRUE(plastic.nonlinear);
    EXPECT_TRUE(plastic.single_return);
    EXPECT_EQ(plastic.diffuse_reflectance.texture, 0);
    EXPECT_EQ(plastic.roughness.distribution, Microfacets::beckmann);
    EXPECT_EQ(back.materials[4].detail, (NormalDetail{1, 0.25f, 0, Rgb(0.5f, 1.0f, 0.25f), true, true}));
    const auto& blend = std::get<BlendMaterial>(back.materials[5].bsdf);
    EXPECT_EQ(blend.weight, FloatInput(0.75f, 2));
    EXPECT_EQ(blend.first, 4);
    EXPECT_EQ(blend.second, 0);
    EXPECT_TRUE(std::holds_alternative<NullMaterial>(back.materials[6].bsdf));
    EXPECT_EQ(back.materials[7].back, 1);
}

TEST(SceneCodec, ShapesRoundTrip) {
    const Scene back = decode_scene(encode_scene(example()));
    const auto& mesh = std::get<Mesh>(back.shapes[0].geometry);
    EXPECT_EQ(mesh.positions[2], Vec3(0, 1, 0));
    EXPECT_EQ(mesh.normals[1], Vec3(0, 1, 0));
    EXPECT_EQ(mesh.uvs[1], Vec2(1, 0));
    EXPECT_EQ(back.shapes[0].material, 1);
    EXPECT_EQ(back.shapes[0].where.text(), "b.xml:3:4");
    const auto& sphere = std::get<Sphere>(back.shapes[1].geometry);
    EXPECT_EQ(sphere.center, Vec3(1, 2, 3));
    EXPECT_EQ(sphere.radius, 4.0f);
    EXPECT_TRUE(sphere.flip_normals);
    EXPECT_TRUE(sphere.mirrored);
    EXPECT_EQ(sphere.pole, Vec3(0, 1, 0));
    EXPECT_EQ(sphere.meridian, Vec3(0, 0, 1));
    const auto& disk = std::get<Disk>(back.shapes[2].geometry);
    EXPECT_EQ(disk.center, Vec3(1, 1, 1));
    EXPECT_EQ(disk.half_u, Vec3(2, 0, 0));
    EXPECT_EQ(disk.half_v, Vec3(1, 3, 0));
    EXPECT_TRUE(disk.mirrored);
    const auto& cylinder = std::get<Cylinder>(back.shapes[3].geometry);
    EXPECT_EQ(cylinder.p0, Vec3(0, 0, 1));
    EXPECT_EQ(cylinder.p1, Vec3(0, 0, 4));
    EXPECT_EQ(cylinder.radius, 2.0f);
    EXPECT_TRUE(cylinder.flip_normals);
    EXPECT_TRUE(cylinder.mirrored);
    EXPECT_EQ(cylinder.meridian, Vec3(0, 1, 0));
    EXPECT_EQ(back.shapes[4].group, 0);
    EXPECT_EQ(std::get<Instance>(back.shapes[5].geometry).to_world,
              std::get<Instance>(example().shapes[5].geometry).to_world);
    EXPECT_EQ(back.group_count, 1);
}

TEST(SceneCodec, EmittersCameraAndFilmRoundTrip) {
    const Scene back = decode_scene(encode_scene(example()));
    EXPECT_EQ(std::get<AreaEmitter>(back.emitters[0].kind).radiance, ColorInput(Rgb(1, 2, 3), 1));
    EXPECT_EQ(std::get<PointEmitter>(back.emitters[2].kind).intensity, Rgb(7, 8, 9));
    const auto& spot = std::get<SpotEmitter>(back.emitters[3].kind);
    EXPECT_EQ(spot.axis, Vec3(0, 1, 0));
    EXPECT_EQ(spot.cutoff, 0.5f);
    EXPECT_EQ(spot.beam, 0.25f);
    EXPECT_EQ(std::get<DirectionalEmitter>(back.emitters[4].kind).direction, Vec3(1, 0, 0));
    const auto& environment = std::get<EnvironmentEmitter>(back.emitters[5].kind);
    EXPECT_TRUE(environment.rows_at_poles);
    EXPECT_EQ(environment.image, 1);
    EXPECT_EQ(environment.scale, 2.0f);
    EXPECT_EQ(environment.z_axis, Vec3(0, 1, 0));
    EXPECT_EQ(back.emitters[5].where.text(), "b.xml:7:7");
    const auto& projector = std::get<ProjectorEmitter>(back.emitters[6].kind);
    EXPECT_EQ(projector.position, Vec3(4, 2, 1));
    EXPECT_EQ(projector.axis, Vec3(0, 0, 1));
    EXPECT_EQ(projector.x_axis, Vec3(0, 1, 0));
    EXPECT_EQ(projector.y_axis, Vec3(-1, 0, 0));
    EXPECT_EQ(projector.half_width, 0.5f);
    EXPECT_EQ(projector.half_height, 0.25f);
    EXPECT_EQ(projector.irradiance, ColorInput(Rgb(3, 2, 1), 1));
    EXPECT_EQ(back.camera.down, Vec3(10, 11, 12));
    EXPECT_EQ(back.camera.lens_v, Vec3(16, 17, 18));
    EXPECT_EQ(back.camera.parallel, Vec3(0, 0, 1));
    EXPECT_TRUE(back.camera.panoramic);
    EXPECT_EQ(back.film.width, 200);
    EXPECT_EQ(back.film.whole_width(), 65535);
    EXPECT_EQ(back.film.filter, PixelFilter::gaussian);
    EXPECT_EQ(back.film.filter_b, 0.25f);
    EXPECT_EQ(back.film.filter_c, 0.75f);
    EXPECT_EQ(back.film.crop, (CropWindow{7, 2, 65535, 9}));

    Scene constant;
    constant.emitters.push_back({ConstantEmitter{Rgb(4, 5, 6)}, {}});
    EXPECT_EQ(std::get<ConstantEmitter>(decode_scene(encode_scene(constant)).emitters[0].kind).radiance, Rgb(4, 5, 6));
}

TEST(SceneCodec, EveryKindOfTheListsTravels) {
    for (const Scene& scene : test::kind_scenes()) {
        const Bytes bytes = encode_scene(scene);
        const Scene back = decode_scene(bytes);
        EXPECT_EQ(encode_scene(back), bytes);
        EXPECT_EQ(back.shapes.back().geometry.index(), scene.shapes.back().geometry.index());
        EXPECT_EQ(back.materials.back().bsdf.index(), scene.materials.back().bsdf.index());
    }
}

/// Calls f for each number and flag of a kind of shape, by a reference that may be changed.
template <class F>
struct EachNumber : IgnoreFields {
    F& f;
    explicit EachNumber(F& call) : f(call) {}
    void vector(auto& v) {
        for (unsigned i = 0; i < v.dimensions(); ++i)
            f(v[static_cast<int>(i)]);
    }
    void list(auto& values) {
        for (auto& v : values)
            vector(v);
    }
    void flag(const char*, bool& value) { f(value); }
    void point(const char*, Vec3& v) { vector(v); }
    void offset(const char*, Vec3& v) { vector(v); }
    void axis(const char*, Vec3& v) { vector(v); }
    void radius(float& value) { f(value); }
    void transform(Imath::M44f& m) {
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 3; ++column)
                f(m[row][column]);
    }
    void vertices(std::vector<Vec3>& positions) { list(positions); }
    void per_vertex(const char*, auto& values) { list(values); }
    void attributes(std::vector<MeshAttribute>& attributes) {
        for (MeshAttribute& attribute : attributes)
            list(attribute.values);
    }
};

/// Adds to a number, or turns a flag round.
struct Change {
    void operator()(float& number) const { number += 1.5f; }
    void operator()(bool& flag) const { flag = !flag; }
};

TEST(SceneCodec, NoNumberOfAShapeIsLeftOut) {
    const Bytes before = encode_scene(example());
    for (std::size_t i = 0; i < example().shapes.size(); ++i) {
        std::size_t count = 0;
        const auto note = [&](auto&) { ++count; };
        Scene scene = example();
        visit_fields(scene.shapes[i].geometry, EachNumber(note));
        for (std::size_t n = 0; n < count; ++n) {
            scene = example();
            std::size_t at = 0;
            const auto change = [&](auto& value) {
                if (at++ == n) Change()(value);
            };
            visit_fields(scene.shapes[i].geometry, EachNumber(change));
            const Bytes bytes = encode_scene(scene);
            EXPECT_NE(bytes, before) << "shape " << i << ", number " << n;
            EXPECT_EQ(bytes.size(), before.size());
            EXPECT_EQ(encode_scene(decode_scene(bytes)), bytes) << "shape " << i << ", number " << n;
        }
    }
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
                // One scene, one byte form: what is readable is written the same way.
                EXPECT_EQ(encode_scene(scene), damaged) << i;
                scene.bounds();
                scene.radiance_scale();
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
    refused([](Scene& s) { s.shapes[0].material = static_cast<std::int32_t>(s.materials.size()); });
    refused([](Scene& s) { s.shapes[0].material = -2; });
    refused([](Scene& s) { s.shapes[0].material = kNone; });
    refused([](Scene& s) { s.shapes[0].emitter = 1; });
    refused([](Scene& s) { s.shapes[0].emitter = 6; });
    refused([](Scene& s) { s.shapes[0].emitter = kNone; });
    refused([](Scene& s) { s.shapes[0].group = 0; });
    refused([](Scene& s) { s.shapes[4].group = 1; });
    refused([](Scene& s) { s.shapes[5].group = 0; });
    refused([](Scene& s) { s.shapes[5].material = 0; });
    refused([](Scene& s) { std::get<Instance>(s.shapes[5].geometry).group = 1; });
    refused([](Scene& s) { std::get<Instance>(s.shapes[5].geometry).group = kNone; });
    refused([](Scene& s) { std::get<Instance>(s.shapes[5].geometry).to_world[2][3] = 1.0f; });
    refused([](Scene& s) { s.group_count = 7; });
    refused([](Scene& s) { s.group_count = -1; });
    refused([](Scene& s) { s.materials[7].back = 7; });
    refused([](Scene& s) { s.materials[7].twosided = false; });
    refused([](Scene& s) { std::get<BlendMaterial>(s.materials[5].bsdf).second = 5; });
    refused([](Scene& s) { std::get<BlendMaterial>(s.materials[5].bsdf).weight.texture = 7; });
    refused([](Scene& s) { std::get<DiffuseMaterial>(s.materials[0].bsdf).reflectance.texture = -2; });
    refused([](Scene& s) { s.materials[4].detail.bump = 7; });
    refused([](Scene& s) { s.materials[4].detail.normal_map = 7; });
    refused([](Scene& s) { s.materials[4].opacity.texture = 7; });
    refused([](Scene& s) { std::get<BitmapTexture>(s.textures[0].kind).image = 3; });
    refused([](Scene& s) { std::get<BitmapTexture>(s.textures[0].kind).image = kNone; });
    refused([](Scene& s) { std::get<BitmapTexture>(s.textures[0].kind).wrap_u = static_cast<Wrap>(5); });
    refused([](Scene& s) { s.images[0].bytes.pop_back(); });
    refused([](Scene& s) { s.images[1].floats.push_back(0.0f); });
    refused([](Scene& s) { s.images[0].width = 0; });
    refused([](Scene& s) { s.images[0].channels = 2; });
    refused([](Scene& s) { std::get<EnvironmentEmitter>(s.emitters[5].kind).image = 2; });
    refused([](Scene& s) { std::get<EnvironmentEmitter>(s.emitters[5].kind).image = 3; });
    refused([](Scene& s) { s.emitters.push_back({ConstantEmitter{}, {}}); });
    refused([](Scene& s) { std::get<AreaEmitter>(s.emitters[0].kind).radiance.texture = 7; });
    refused([](Scene& s) { std::get<SpotEmitter>(s.emitters[3].kind).texture = 7; });
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
