// SPDX-License-Identifier: Apache-2.0
// AOVs one by one: each alone, of which side, sample, camera and shape they are, and that their rays are the image's.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/aov_render.h"
#include "worker/integrators/first_hit/first_hit.h"

namespace treefarm {
namespace {

using test::add_diffuse;
using test::add_material;
using test::add_shape;
using test::kFirstHitAovs;
using test::Layers;
using test::one_pass;
using test::quad;
using test::render_layers;
using test::wall_scene;

/// Each asks for what it is made of by itself: distances need to know how many samples met something.
TEST(FirstSurface, EachLayerAloneIsWhatItIsAmongAll) {
    const Scene scene = wall_scene(0.55f);  // pixels at the wall's edge are partly empty
    std::string all;
    for (const AovKind& kind : aov_kinds())
        all += (all.empty() ? "" : ",") + std::string(kind.name);
    const Layers together = render_layers(scene, all);
    bool partly = false;
    for (const float alpha : together["A"])
        partly |= alpha > 0.0f && alpha < 1.0f;
    ASSERT_TRUE(partly);
    for (const AovKind& kind : aov_kinds())
        for (const AovChannel& channel : render_layers(scene, kind.name).channels)
            EXPECT_EQ(channel.values, together[channel.name]) << channel.name;
}

TEST(FirstSurface, NormalsAreTheGeometricAndTheShadingOneTurnedTowardsTheCamera) {
    for (const bool from_behind : {false, true}) {
        Scene scene = wall_scene();
        auto& wall = std::get<Mesh>(scene.shapes[0].geometry);
        const Vec3 tilted = normalize(Vec3(0.0f, 0.6f, -2.0f));
        if (from_behind) std::swap(wall.indices[1], wall.indices[2]), std::swap(wall.indices[4], wall.indices[5]);
        wall.normals.assign(4, from_behind ? -tilted : tilted);
        const Layers image = render_layers(scene, "normal,geometric_normal");
        for (std::size_t p = 0; p < 64; ++p) {
            EXPECT_LT((image.vector("geometric_normal", p) - Vec3(0, 0, -1)).length(), 1e-6f);
            EXPECT_LT((image.vector("normal", p) - tilted).length(), 1e-5f) << image.vector("normal", p);
        }
    }
}

TEST(FirstSurface, NumbersAreThoseOfThePixelsFirstSample) {
    Scene scene = wall_scene();
    const std::int32_t red = add_diffuse(scene, {0.7f, 0.2f, 0.1f});
    scene.shapes.clear();
    add_shape(scene, quad({-5, -5, 10}, {0, 10, 0}, {5.1f, 0, 0}), 0);  // their border is within a column of pixels
    add_shape(scene, quad({0.1f, -5, 10}, {0, 10, 0}, {5, 0, 0}), red);
    const Layers first = render_layers(scene, "albedo,shape,material", 1),
                 image = render_layers(scene, "albedo,shape,material,alpha", 100);
    bool mixed[3] = {};
    for (std::size_t p = 0; p < 64; ++p) {
        EXPECT_EQ(image["shape.I"][p], first["shape.I"][p]);
        EXPECT_EQ(image["material.I"][p], first["material.I"][p]);
        EXPECT_EQ(first["shape.I"][p], first["albedo.B"][p] > 0.5f ? 1.0f : 2.0f);
        EXPECT_EQ(image["material.I"][p], image["shape.I"][p]) << "each has its own";
        const bool both = image["albedo.B"][p] > 0.11f && image["albedo.B"][p] < 0.69f;
        mixed[static_cast<int>(image["shape.I"][p])] |= both;
    }
    EXPECT_TRUE(mixed[1] && mixed[2]) << "of either there are pixels that see both";
}

TEST(FirstSurface, AnInstanceIsAShapeOfItsOwnWithItsMembersMaterial) {
    Scene scene = wall_scene();
    const std::int32_t red = add_diffuse(scene, {0.7f, 0.2f, 0.1f});
    scene.shapes.clear();
    add_shape(scene, quad({-5, -5, 0}, {0, 10, 0}, {5, 0, 0}), red);
    scene.shapes.back().group = 0;
    scene.group_count = 1;
    for (const float x : {0.0f, 5.0f}) {
        Imath::M44f to_world;
        to_world.setTranslation(Vec3(x, 0, 10));
        add_shape(scene, Instance{0, to_world}, kNone);
    }
    const Layers image = render_layers(scene, "shape,material,position");
    for (std::size_t p = 0; p < 64; ++p) {
        EXPECT_EQ(image["shape.I"][p], image["position.X"][p] < 0.0f ? 2.0f : 3.0f);
        EXPECT_EQ(image["material.I"][p], 2.0f);
    }
}

TEST(FirstSurface, DepthIsAlongTheAxisAndDistanceAlongTheRayOfAnyCamera) {
    Scene scene = wall_scene();
    scene.camera.lens_u = {0.5f, 0, 0};
    scene.camera.lens_v = {0, 0.5f, 0};
    const Layers lens = render_layers(scene, "depth,distance,position");
    scene = wall_scene();
    scene.camera.down *= -1.0f;  // upside down: its film's sides are turned the other way
    scene.camera.corner.y *= -1.0f;
    const Layers mirrored = render_layers(scene, "depth,position");
    scene = wall_scene();
    scene.camera.origin.z = 1.0f;
    const Layers nearer = render_layers(scene, "depth");
    scene = wall_scene();
    scene.camera.parallel = {0, 0, 1};
    scene.camera.corner = {2, 2, 0};
    scene.camera.across = {-4, 0, 0};
    scene.camera.down = {0, -4, 0};
    const Layers parallel = render_layers(scene, "depth,distance,position");
    scene.camera = {};
    scene.camera.panoramic = true;
    scene.camera.across = {1, 0, 0};
    scene.camera.down = {0, 1, 0};
    scene.camera.corner = {0, 0, 1};
    test::set_film(scene, 64, 32);
    const Layers panorama = render_layers(scene, "depth,distance,alpha", 1);
    for (std::size_t p = 0; p < 64; ++p) {
        EXPECT_NEAR(lens["depth.Z"][p], 10.0f, 1e-4f);
        EXPECT_NEAR(mirrored["depth.Z"][p], 10.0f, 1e-4f);
        EXPECT_NEAR(nearer["depth.Z"][p], 9.0f, 1e-4f);
        EXPECT_NEAR(parallel["depth.Z"][p], 10.0f, 1e-4f);
        EXPECT_NEAR(parallel["distance.Z"][p], 10.0f, 1e-4f) << "from where the ray began, not from the camera's place";
        // All of the lens' points see what the pinhole sees in focus, at distance 1: beyond it paths spread.
        EXPECT_GT(lens["distance.Z"][p], 10.0f);
    }
    EXPECT_GT(mirrored["position.Y"][63], 0.0f);
    int seen = 0;
    for (std::size_t p = 0; p < panorama["A"].size(); ++p) {
        EXPECT_EQ(panorama["depth.Z"][p], panorama["distance.Z"][p]);
        seen += panorama["A"][p] > 0.0f && panorama["distance.Z"][p] > 10.2f;
    }
    EXPECT_GT(seen, 20);
}

/// An axis is of length 1, ahead, and normal to the film, also where the film is not.
TEST(FirstSurface, TheAxisOfACameraIsNormalToItsFilm) {
    const Vec3 ahead = normalize(Vec3(1, 2, 3));
    Camera camera = test::look_at({4, 5, 6}, Vec3(4, 5, 6) + ahead, {0, 1, 0}, 0.3f);
    camera.corner += 0.2f * camera.across - 0.1f * camera.down;  // as a window off the axis
    EXPECT_LT((camera_axis(camera) - ahead).length(), 1e-5f);
    camera.across *= -1.0f;
    EXPECT_LT((camera_axis(camera) - ahead).length(), 1e-5f);
    camera.parallel = ahead;
    camera.corner *= -1.0f;  // where the film is says nothing of where it looks
    EXPECT_LT((camera_axis(camera) - ahead).length(), 1e-5f);
    camera.across = camera.down;
    EXPECT_LT((camera_axis(camera) - ahead).length(), 1e-5f) << "a film without a plane";
    camera.panoramic = true;
    EXPECT_EQ(camera_axis(camera), Vec3(0.0f));
}

TEST(FirstSurface, WhatIsNoSurfaceIsLookedThrough) {
    Scene scene = wall_scene();
    const std::int32_t nothing = add_material(scene, NullMaterial{});
    add_shape(scene, quad({-5, -5, 6}, {0, 10, 0}, {10, 0, 0}), nothing);
    const Layers image = render_layers(scene, kFirstHitAovs);
    for (std::size_t p = 0; p < 64; ++p) {
        EXPECT_NEAR(image["depth.Z"][p], 10.0f, 1e-4f);
        EXPECT_GT(image["distance.Z"][p], 10.0f) << "from the camera, not from what was looked through";
        EXPECT_EQ(image["A"][p], 1.0f);
        EXPECT_EQ(image["shape.I"][p], 1.0f);
        EXPECT_NEAR(image["albedo.B"][p], 0.7f, 1e-5f);
    }
}

double mean(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values)
        sum += static_cast<double>(value);
    return sum / static_cast<double>(values.size());
}

/// In even white light from all around a surface that lets none through is as bright as its albedo.
TEST(FirstSurface, AlbedoIsTheBrightnessInWhiteLight) {
    const Roughness rough = test::rough(Microfacets::ggx, 0.4f, 0.4f);
    PlasticMaterial plastic, rough_plastic;
    plastic.diffuse_reflectance = rough_plastic.diffuse_reflectance = Rgb(0.2f, 0.5f, 0.9f);
    rough_plastic.roughness = rough;
    ConductorMaterial metal;
    metal.eta = {0.2f, 0.9f, 1.1f};
    metal.k = {3.9f, 2.5f, 2.4f};
    metal.roughness = rough;
    const auto expect_bright = [](const Scene& scene, double tolerance, const char* what) {
        Job job;
        job.integrator.max_depth = 2;
        const Layers image = render_layers(scene, "albedo", 256, job);
        const char* const channels[] = {"albedo.R", "albedo.G", "albedo.B"};
        for (int c = 0; c < 3; ++c) {
            double bright = 0;
            for (const PixelEstimate& pixel : image.pixels)
                bright += pixel.whole().mean[c] / static_cast<double>(image.pixels.size());
            EXPECT_NEAR(mean(image[channels[c]]), bright, tolerance) << what;
        }
    };
    Scene scene = wall_scene();
    expect_bright(scene, 0.01, "diffuse");
    scene.materials[0].bsdf = plastic;
    expect_bright(scene, 0.03, "plastic");
    scene.materials[0].bsdf = rough_plastic;
    expect_bright(scene, 0.05, "rough plastic");
    scene.materials[0].bsdf = metal;
    expect_bright(scene, 0.05, "rough metal");
}

/// Radiance that is refracted into glass is squeezed into fewer directions, which is no matter of the glass.
TEST(FirstSurface, RoughGlassThatTakesNothingIsWhite) {
    for (const bool from_within : {false, true}) {
        Scene scene = wall_scene();
        DielectricMaterial glass;
        glass.roughness = test::rough(Microfacets::ggx, 0.1f, 0.1f);
        if (from_within) glass.eta = 1 / glass.eta;
        scene.materials[0].bsdf = glass;
        const Layers image = render_layers(scene, "albedo,depth");
        EXPECT_GT(mean(image["albedo.G"]), 0.93);
        for (const float albedo : image["albedo.G"])
            EXPECT_LE(albedo, 1.0f);
        EXPECT_NEAR(image["depth.Z"][0], 10.0f, 1e-4f);
    }
}

/// The rays are those of the image's paths, in each pass: what `normals` shows is what the layer holds.
TEST(FirstSurface, RaysAreThoseOfTheImage) {
    Scene scene = wall_scene();
    auto& wall = std::get<Mesh>(scene.shapes[0].geometry);
    wall.normals = {normalize(Vec3(-1, -1, -2)), normalize(Vec3(-1, 1, -2)), normalize(Vec3(1, 1, -2)),
                    normalize(Vec3(1, -1, -2))};
    Job job;
    job.integrator.type = "normals";
    PassPlan later = one_pass(3);
    later.index = 1;
    later.first_sample = 7;
    const Layers image = render_layers(scene, "normal", std::vector{later}, job);
    for (std::size_t p = 0; p < 64; ++p) {
        const Rgb64 colour = image.pixels[p].whole().mean;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(2 * colour[c] - 1, static_cast<double>(image.vector("normal", p)[c]), 1e-6) << p;
    }
}

TEST(FirstSurface, LayersOfPassesAndOfCutPassesAreThoseOfOnePass) {
    const Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    const auto pass = [](std::uint32_t index, std::uint32_t first, std::uint32_t spp, std::uint32_t chunks) {
        PassPlan plan = one_pass(spp);
        plan.index = index;
        plan.first_sample = first;
        plan.chunks = chunks;
        plan.blocks_per_unit = chunks == 1 ? 16 : 1;
        return plan;
    };
    Scene small = scene;
    test::set_film(small, 6, 6);
    const std::string aovs = std::string(kFirstHitAovs) + ",direct";
    const Layers whole = render_layers(small, aovs, std::vector{pass(0, 0, 192, 1)});
    const Layers cut = render_layers(small, aovs, std::vector{pass(0, 0, 192, 3)});
    const Layers passes = render_layers(small, aovs, std::vector{pass(0, 0, 64, 1), pass(1, 64, 128, 1)});
    for (std::size_t c = 0; c < whole.channels.size(); ++c) {
        const std::string& name = whole.channels[c].name;
        EXPECT_EQ(cut.channels[c].values, whole.channels[c].values) << name;
        for (std::size_t p = 0; p < 36; ++p)
            EXPECT_NEAR(passes[name][p], whole[name][p], 1e-5f * (1 + std::abs(whole[name][p]))) << name;
    }
}

}  // namespace
}  // namespace treefarm
