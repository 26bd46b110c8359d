// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/check/validate.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/scene/pack/scene_codec.h"
#include "tests/support/every_kind.h"

namespace treefarm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

template <class Kind>
Kind& geometry(Scene& scene, std::size_t shape) {
    return std::get<Kind>(scene.shapes[shape].geometry);
}

template <class Kind>
Kind& bsdf(Scene& scene, std::size_t material) {
    return std::get<Kind>(scene.materials[material].bsdf);
}

template <class Kind>
Kind& kind(Scene& scene, std::size_t emitter) {
    return std::get<Kind>(scene.emitters[emitter].kind);
}

/// The scene of every kind, changed, is refused with a message that contains `about`.
template <class Change>
void expect_refused(const std::string& about, Change change) {
    Scene scene = test::every_kind_scene();
    change(scene);
    std::vector<Warning> warnings;
    try {
        validate_scene(scene, warnings);
        ADD_FAILURE() << "accepted, though: " << about;
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(about), std::string::npos) << error.what();
    }
}

/// The scene of every kind, changed, is accepted, with so many warnings.
template <class Change>
Scene expect_accepted(std::size_t warning_count, Change change) {
    Scene scene = test::every_kind_scene();
    change(scene);
    std::vector<Warning> warnings;
    validate_scene(scene, warnings);
    EXPECT_EQ(warnings.size(), warning_count);
    return scene;
}

TEST(ValidateKinds, EveryKindIsAcceptedUnchanged) {
    const Scene scene = expect_accepted(0, [](Scene&) {});
    EXPECT_EQ(encode_scene(scene), encode_scene(test::every_kind_scene()));
}

TEST(ValidateKinds, Images) {
    expect_refused("sky.exr: the image has a value", [](Scene& s) { s.images[1].floats[0] = kInf; });
    expect_refused("wood.png: ", [](Scene& s) { s.images[0].decode[7] = kNan; });
    expect_refused("wood.png: ", [](Scene& s) { s.images[0].width = 3; });
    expect_refused("wood.png: ", [](Scene& s) { s.images[0].floats.push_back(0.0f); });
    expect_refused("pixels", [](Scene& s) { s.images[0].height = 65536; });
    expect_refused("2 channels", [](Scene& s) { s.images[2].channels = 2; });
    expect_refused("pixels", [](Scene& s) { s.images.emplace_back(); });
}

TEST(ValidateKinds, Textures) {
    expect_refused("a.xml:1:2: the texture has no image",
                   [](Scene& s) { std::get<BitmapTexture>(s.textures[0].kind).image = 3; });
    expect_refused("a.xml:1:2: ", [](Scene& s) { std::get<BitmapTexture>(s.textures[0].kind).uv.u_row.z = kNan; });
    expect_refused("checkerboard", [](Scene& s) { std::get<CheckerboardTexture>(s.textures[1].kind).color1.x = kInf; });
}

TEST(ValidateKinds, AttributesOfMeshes) {
    const auto attributes = [](Scene& s) -> std::vector<MeshAttribute>& { return geometry<Mesh>(s, 4).attributes; };
    const Scene fewer = expect_accepted(0, [&](Scene& s) {
        attributes(s).push_back({"vertex_heat", {Rgb(kNan)}});
        bsdf<DiffuseMaterial>(s, 7).reflectance.texture = kNone;
    });
    const auto& left = std::get<Mesh>(fewer.shapes[4].geometry).attributes;
    ASSERT_EQ(left.size(), 1u) << "what nobody asks for is neither checked nor kept";
    EXPECT_EQ(left[0].name, "face_wear");
    expect_refused("b.xml:6:2: shape \"part\" has no vertex_color, which its texture asks for; it has face_wear",
                   [&](Scene& s) { attributes(s).erase(attributes(s).begin()); });
    expect_refused("red, green and blue", [&](Scene& s) { attributes(s).clear(); });
    expect_refused("has 2 values of vertex_color for its 3 vertices",
                   [&](Scene& s) { attributes(s)[0].values.pop_back(); });
    expect_refused("has 2 values of face_wear for its 1 triangles",
                   [&](Scene& s) { attributes(s)[1].values.push_back(Rgb(1.0f)); });
    expect_refused("has a face_wear that is not finite", [&](Scene& s) { attributes(s)[1].values[0].y = kNan; });
    expect_refused("the shape is no mesh, so it has no face_wear", [](Scene& s) { s.shapes[1].material = 7; });
    expect_refused("the emitter has the texture mesh_attribute, but no mesh",
                   [](Scene& s) { kind<SpotEmitter>(s, 3).texture = 3; });
}

TEST(ValidateKinds, AttributesOfTrianglesWithoutAreaGoWithThem) {
    const Scene scene = expect_accepted(1, [](Scene& s) {
        Mesh& mesh = geometry<Mesh>(s, 4);
        mesh.indices = {0, 0, 1, 0, 1, 2, 1, 1, 1};
        mesh.attributes[1].values = {Rgb(1.0f), Rgb(0.5f), Rgb(0.25f)};
    });
    EXPECT_EQ(std::get<Mesh>(scene.shapes[4].geometry).attributes[1].values, std::vector<Rgb>{Rgb(0.5f)});
}

TEST(ValidateKinds, Materials) {
    expect_refused("a.xml:1:7: ", [](Scene& s) { bsdf<DiffuseMaterial>(s, 0).reflectance.value.x = -1.0f; });
    expect_refused("texture that does not", [](Scene& s) { bsdf<DiffuseMaterial>(s, 0).reflectance.texture = 7; });
    expect_refused("a.xml:2:7: ", [](Scene& s) { bsdf<ConductorMaterial>(s, 1).k.y = -1.0f; });
    expect_refused("a.xml:2:7: ", [](Scene& s) { bsdf<ConductorMaterial>(s, 1).eta.y = kInf; });
    expect_refused("alpha", [](Scene& s) { bsdf<ConductorMaterial>(s, 1).roughness.alpha_u.value = 0.0f; });
    expect_refused("alpha", [](Scene& s) { bsdf<ConductorMaterial>(s, 1).roughness.alpha_v.value = kNan; });
    expect_refused("refraction", [](Scene& s) { bsdf<DielectricMaterial>(s, 2).eta = 0.0f; });
    expect_refused("refraction", [](Scene& s) { bsdf<ThinDielectricMaterial>(s, 3).eta = -1.5f; });
    expect_refused("refraction", [](Scene& s) { bsdf<PlasticMaterial>(s, 4).eta = kInf; });
    expect_refused("transmittance",
                   [](Scene& s) { bsdf<DielectricMaterial>(s, 2).specular_transmittance = Rgb(1.5f); });
    expect_refused("plastic", [](Scene& s) { bsdf<PlasticMaterial>(s, 4).roughness.alpha_u.value = 0.5f; });
    expect_refused("weight", [](Scene& s) { bsdf<BlendMaterial>(s, 5).weight = 1.5f; });
    expect_refused("itself", [](Scene& s) { bsdf<BlendMaterial>(s, 5).first = 5; });
    expect_refused("itself", [](Scene& s) { bsdf<BlendMaterial>(s, 5).second = kNone; });
    expect_refused("itself", [](Scene& s) { s.materials[7].back = 7; });
    expect_refused("a.xml:8:7: ", [](Scene& s) { s.materials[7].twosided = false; });
    expect_refused("light passes", [](Scene& s) { s.materials[7].back = 2; });
    expect_refused("light passes", [](Scene& s) { s.materials[6].twosided = true; });
    expect_refused("light passes", [](Scene& s) {
        bsdf<BlendMaterial>(s, 5).first = 3;
        s.materials[5].twosided = true;
    });
    expect_refused("opacity", [](Scene& s) { s.materials[0].opacity = 1.01f; });
    expect_refused("bump", [](Scene& s) { s.materials[4].detail.bump_scale = kNan; });
    expect_refused("does not exist", [](Scene& s) { s.materials[4].detail.bump = 7; });
    expect_refused("normal map", [](Scene& s) { s.materials[4].detail.normal_scale.x = kNan; });
    expect_accepted(0, [](Scene& s) { s.materials[4].detail.normal_map = 1; });
    expect_refused("negative", [](Scene& s) { std::get<CheckerboardTexture>(s.textures[1].kind).color0.x = -0.5f; });
}

TEST(ValidateKinds, TinyRoughnessIsRaised) {
    Scene scene = expect_accepted(1, [](Scene& s) { bsdf<ConductorMaterial>(s, 1).roughness.alpha_u.value = 1e-6f; });
    EXPECT_EQ(bsdf<ConductorMaterial>(scene, 1).roughness.alpha_u.value, 1e-4f);
}

TEST(ValidateKinds, TexturedFactorsAbove1AreScaledDown) {
    Scene scene = expect_accepted(1, [](Scene& s) {
        s.images[2].floats[0] = 3.0f, s.materials[2].opacity = {0.5f, 2};
    });
    EXPECT_FLOAT_EQ(scene.materials[2].opacity.value * 3.0f, 0.99f);
    // wrap_v = one: outside of the image the texture is 1 even where the image is darker.
    const auto reflectance = [](bool unlimited) {
        const Scene scene = expect_accepted(1, [&](Scene& s) {
            s.materials[0].unlimited = unlimited;
            bsdf<DiffuseMaterial>(s, 0).reflectance.value = Rgb(1.0f, 2.0f, 0.5f);
        });
        return std::get<DiffuseMaterial>(scene.materials[0].bsdf).reflectance.value;
    };
    EXPECT_FLOAT_EQ(reflectance(false).y, 0.99f);
    EXPECT_FLOAT_EQ(reflectance(false).z, 0.2475f);
    EXPECT_EQ(reflectance(true), Rgb(1.0f, 2.0f, 0.5f));
}

TEST(ValidateKinds, AnalyticShapes) {
    expect_refused("right angles", [](Scene& s) { geometry<Sphere>(s, 1).pole = Vec3(0, 0, 1); });
    expect_refused("right angles", [](Scene& s) { geometry<Sphere>(s, 1).meridian = Vec3(kNan); });
    expect_refused("1e18", [](Scene& s) { geometry<Sphere>(s, 1).radius = 2e18f; });
    expect_refused("\"disk\" has no area", [](Scene& s) { geometry<Disk>(s, 2).half_v = Vec3(4, 0, 0); });
    expect_refused("\"disk\" has no area",
                   [](Scene& s) { geometry<Disk>(s, 2).half_u = geometry<Disk>(s, 2).half_v = Vec3(0.0f); });
    expect_refused("\"disk\" is not finite", [](Scene& s) { geometry<Disk>(s, 2).half_v.z = kInf; });
    expect_refused("1e18", [](Scene& s) { geometry<Disk>(s, 2).center.x = -2e18f; });
    expect_refused("radius", [](Scene& s) { geometry<Cylinder>(s, 3).radius = 0.0f; });
    expect_refused("no length", [](Scene& s) { geometry<Cylinder>(s, 3).p1 = geometry<Cylinder>(s, 3).p0; });
    expect_refused("right angles", [](Scene& s) { geometry<Cylinder>(s, 3).meridian = Vec3(0, 0, 1); });
    expect_refused("not finite", [](Scene& s) { geometry<Cylinder>(s, 3).p0.x = kNan; });
    expect_refused("1e18", [](Scene& s) { geometry<Cylinder>(s, 3).p1.z = 1e19f; });
}

TEST(ValidateKinds, GroupsAndInstances) {
    const auto matrix = [](Scene& s) -> Imath::M44f& { return geometry<Instance>(s, 5).to_world; };
    expect_refused("b.xml:9:9: shape \"placed\" places a group", [](Scene& s) { geometry<Instance>(s, 5).group = 1; });
    expect_refused("places a group", [](Scene& s) { geometry<Instance>(s, 5).group = kNone; });
    expect_refused("places a group", [](Scene& s) { s.shapes[4].group = kNone; });
    expect_refused("flattens", [&](Scene& s) { matrix(s)[2][2] = 0.0f; });
    expect_refused("not finite", [&](Scene& s) { matrix(s)[3][2] = kNan; });
    expect_refused("affine", [&](Scene& s) { matrix(s)[3][3] = 2.0f; });
    expect_refused("1e18", [&](Scene& s) { matrix(s)[3][0] = 1e19f; });
    expect_refused("1e18", [&](Scene& s) {
        geometry<Mesh>(s, 4).positions[1].x = 1e10f;
        matrix(s)[0][1] = 1e10f;
    });
    expect_refused("within a group", [](Scene& s) { s.shapes[5].group = 0; });
    expect_refused("of its own", [](Scene& s) { s.shapes[5].material = 0; });
    expect_refused("within a group", [](Scene& s) { s.shapes[0].group = 0; });
    expect_refused("does not exist", [](Scene& s) { s.shapes[4].group = 1; });
    expect_refused("does not exist", [](Scene& s) { s.shapes[4].group = -2; });
    expect_refused("more groups", [](Scene& s) { s.group_count = 7; });
    expect_refused("more groups", [](Scene& s) { s.group_count = -1; });
}

TEST(ValidateKinds, Emitters) {
    expect_refused("b.xml:5:6: ", [](Scene& s) { kind<AreaEmitter>(s, 0).radiance.texture = 7; });
    expect_refused("intensity", [](Scene& s) { kind<PointEmitter>(s, 2).intensity.x = -1.0f; });
    expect_refused("position", [](Scene& s) { kind<PointEmitter>(s, 2).position.x = 1e19f; });
    expect_refused("direction", [](Scene& s) { kind<SpotEmitter>(s, 3).axis = Vec3(0.0f); });
    expect_refused("cutoff", [](Scene& s) { kind<SpotEmitter>(s, 3).cutoff = 0.0f; });
    expect_refused("cutoff", [](Scene& s) { kind<SpotEmitter>(s, 3).cutoff = 3.2f; });
    expect_refused("beam", [](Scene& s) { kind<SpotEmitter>(s, 3).beam = 0.6f; });
    expect_refused("beam", [](Scene& s) { kind<SpotEmitter>(s, 3).beam = kNan; });
    expect_refused("below 90 degrees", [](Scene& s) { kind<SpotEmitter>(s, 3).cutoff = 1.6f; });
    expect_refused("does not exist", [](Scene& s) { kind<SpotEmitter>(s, 3).texture = 7; });
    expect_refused("direction", [](Scene& s) { kind<SpotEmitter>(s, 3).x_axis = Vec3(0.0f); });
    expect_refused("direction", [](Scene& s) { kind<DirectionalEmitter>(s, 4).direction = Vec3(2, 0, 0); });
    expect_refused("irradiance", [](Scene& s) { kind<DirectionalEmitter>(s, 4).irradiance.z = kInf; });
    expect_refused("b.xml:7:7: ", [](Scene& s) { kind<EnvironmentEmitter>(s, 5).image = 3; });
    expect_refused("three channels", [](Scene& s) { kind<EnvironmentEmitter>(s, 5).image = 2; });
    expect_refused("negative", [](Scene& s) { s.images[1].floats[2] = -1.0f; });
    expect_refused("scale", [](Scene& s) { kind<EnvironmentEmitter>(s, 5).scale = kNan; });
    expect_refused("right angles", [](Scene& s) { kind<EnvironmentEmitter>(s, 5).x_axis = Vec3(1, 0, 0); });
    expect_refused("b.xml:8:8: ", [](Scene& s) { kind<ProjectorEmitter>(s, 6).position.x = kNan; });
    expect_refused("direction", [](Scene& s) { kind<ProjectorEmitter>(s, 6).y_axis = Vec3(0.0f); });
    expect_refused("right angles", [](Scene& s) { kind<ProjectorEmitter>(s, 6).x_axis = Vec3(1, 0, 0); });
    expect_refused("field of view", [](Scene& s) { kind<ProjectorEmitter>(s, 6).half_width = 0.0f; });
    expect_refused("field of view", [](Scene& s) { kind<ProjectorEmitter>(s, 6).half_height = kInf; });
    expect_refused("irradiance", [](Scene& s) { kind<ProjectorEmitter>(s, 6).irradiance.value.y = -1.0f; });
    expect_refused("does not exist", [](Scene& s) { kind<ProjectorEmitter>(s, 6).irradiance.texture = 7; });
    expect_refused("second environment", [](Scene& s) { s.emitters.push_back({ConstantEmitter{}, {}}); });
    expect_refused("not its shape's", [](Scene& s) { s.emitters.push_back({AreaEmitter{Rgb(1.0f), 1}, {}}); });
}

TEST(ValidateKinds, Lens) {
    expect_refused("camera", [](Scene& s) { s.camera.lens_u.x = kNan; });
    expect_refused("camera", [](Scene& s) { s.camera.origin.x = 1e19f; });
}

}  // namespace
}  // namespace treefarm
