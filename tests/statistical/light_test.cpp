// SPDX-License-Identifier: Apache-2.0
// Light tracing and bidirectional path tracing against path tracing, where all find all light, and against what is
// known exactly.
#include <gtest/gtest.h>

#include "tests/support/chi_square.h"
#include "tests/support/rendered.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

using test::expect_same_image;
using test::Rendered;

Rendered render_light_paths(const Scene& scene, Job job, const char* type, std::uint64_t seed, std::uint32_t spp,
                            bool next_event = true) {
    job.integrator.type = type;
    job.sampler.seed = seed;
    job.budget.spp = spp;
    job.guiding.type = GuidingType::none;
    job.bidirectional.light_subpaths = Rule::always;
    job.integrator.next_event = next_event ? NextEvent::always : NextEvent::never;
    const test::LocalRender run = test::render_locally(scene, job);
    EXPECT_EQ(run.splat_caps, SplatCaps{}) << type;
    return test::rendered(run, scene.film);
}

void expect_image_of_paths(const Scene& scene, const Job& job, const std::string& what, std::uint32_t light_spp = 60,
                           std::uint32_t path_spp = 60) {
    const Rendered path = render_light_paths(scene, job, "reference", 32, path_spp);
    expect_same_image(render_light_paths(scene, job, "light", 31, light_spp), path, what + ", light");
    expect_same_image(render_light_paths(scene, job, "bidirectional", 33, light_spp / 2), path,
                      what + ", bidirectional", 0.04);
}

Scene small(Scene scene, int width = 32, int height = 32) {
    test::set_film(scene, width, height);
    return scene;
}

/// Each length of paths alone, as all up to it.
TEST(LightsAgainstPath, OfEachLength) {
    for (int depth = 1; depth <= 4; ++depth) {
        Job job;
        job.integrator.max_depth = depth;
        expect_image_of_paths(small(test::cornell_box(1.0f, Vec3(0.0f))), job, "depth " + std::to_string(depth));
    }
}

TEST(LightsAgainstPath, AtAnyScaleAndPositionWithoutLimit) {
    for (const auto& [scale, offset] : {std::pair(1.0f, 0.0f), {1e-4f, 0.0f}, {1e5f, 0.0f}, {1.0f, 1e3f}})
        expect_image_of_paths(small(test::cornell_box(scale, Vec3(offset))), {}, "scale " + std::to_string(scale));
}

TEST(LightsAgainstPath, LampsHiddenFromTheCamera) {
    Job job;
    job.integrator.hide_emitters = true;
    expect_image_of_paths(small(test::cornell_box(1.0f, Vec3(0.0f))), job, "hidden");
}

std::int32_t add_material(Scene& scene, const Material& material) {
    scene.materials.push_back(material);
    return static_cast<std::int32_t>(scene.materials.size()) - 1;
}

Material rough(decltype(Material::bsdf) bsdf, bool twosided = false) {
    Material material;
    material.bsdf = std::move(bsdf);
    material.twosided = twosided;
    return material;
}

/// A corner of three planes with rough surfaces that all scatter otherwise, and a ball with shading normals.
Scene studio() {
    Scene scene;
    PlasticMaterial plastic;
    plastic.diffuse_reflectance = ColorInput(Rgb(0.5f, 0.3f, 0.2f));
    plastic.roughness.alpha_u = plastic.roughness.alpha_v = FloatInput(0.3f);
    plastic.roughness.distribution = Microfacets::ggx;
    RoughDiffuseMaterial matte;
    matte.reflectance = ColorInput(Rgb(0.6f));
    PhongMaterial phong;
    PrincipledMaterial principled;
    principled.base_color = ColorInput(Rgb(0.2f, 0.5f, 0.7f));
    principled.roughness = FloatInput(0.5f);
    principled.metallic = FloatInput(0.3f);
    test::add_shape(scene, test::quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), add_material(scene, rough(plastic)));
    test::add_shape(scene, test::quad({-2, 0, 2}, {0, 4, 0}, {4, 0, 0}), add_material(scene, rough(matte, true)));
    test::add_shape(scene, test::quad({-2, 0, -2}, {0, 4, 0}, {0, 0, 4}), add_material(scene, rough(phong, true)));
    test::add_shape(scene, test::sphere_mesh({0.2f, 0.7f, 0.5f}, 0.6f, 2, true),
                    add_material(scene, rough(principled)));
    scene.camera = test::look_at({1.2f, 1.6f, -3.5f}, {0, 0.8f, 0.3f}, {0, 1, 0}, 0.45f);
    test::set_film(scene, 32, 32);
    return scene;
}

TEST(LightsAgainstPath, EveryKindOfEmitter) {
    Job job;
    job.integrator.hide_emitters = true;  // what is seen at infinity light tracing does not find
    const auto with = [&](const std::string& what, auto&& add) {
        Scene scene = studio();
        add(scene);
        expect_image_of_paths(scene, job, what);
    };
    with("ball", [](Scene& s) {
        test::add_shape(s, Sphere{Vec3(-0.5f, 2.2f, -0.6f), 0.3f, false}, kNone, Rgb(8, 7, 6));
    });
    with("disk", [](Scene& s) {
        Disk disk;
        disk.center = Vec3(0.5f, 2.5f, -0.5f);
        disk.half_u = Vec3(0.4f, 0, 0);
        disk.half_v = Vec3(0, 0, 0.3f);
        test::add_shape(s, disk, kNone, Rgb(20.0f));
    });
    with("point and spot", [](Scene& s) {
        s.emitters.push_back({PointEmitter{{-0.8f, 2.0f, -0.5f}, Rgb(2.0f)}, {}});
        SpotEmitter spot;
        spot.position = Vec3(1, 3, -1);
        spot.axis = normalize(Vec3(-1, -2.5f, 1));
        spot.intensity = Rgb(9.0f);
        spot.cutoff = 0.5f;
        spot.beam = 0.2f;
        s.emitters.push_back({spot, {}});
    });
    with("projector and sun", [](Scene& s) {
        ProjectorEmitter projector;
        projector.position = Vec3(1.5f, 2.0f, -2.0f);
        projector.axis = normalize(Vec3(-1.2f, -1.2f, 2.5f));
        projector.x_axis = normalize(cross(Vec3(0, 1, 0), projector.axis));
        projector.y_axis = cross(projector.axis, projector.x_axis);
        projector.half_width = projector.half_height = 0.4f;
        projector.irradiance = ColorInput(Rgb(20.0f));
        s.emitters.push_back({projector, {}});
        s.emitters.push_back({DirectionalEmitter{normalize(Vec3(-0.5f, -1, 0.6f)), Rgb(1.0f)}, {}});
    });
    with("even sky", [](Scene& s) { s.emitters.push_back({ConstantEmitter{Rgb(0.4f, 0.5f, 0.7f)}, {}}); });
    with("image of a sky", [](Scene& s) {
        TextureImage image;
        image.width = 8;
        image.height = 4;
        for (int i = 0; i < 96; ++i)
            image.floats.push_back(i == 30 || i == 31 ? 20.0f : 0.3f + 0.01f * static_cast<float>(i % 7));
        EnvironmentEmitter sky;
        sky.image = 0;
        s.images.push_back(image);
        s.emitters.push_back({sky, {}});
    });
}

/// A lamp of 2 x 2 at height 3 over a floor.
Scene floor_and_lamp() {
    Scene scene;
    test::add_shape(scene, test::quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), test::add_diffuse(scene, {0.7f, 0.5f, 0.6f}));
    test::add_shape(scene, test::quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}), kNone, Rgb(3.0f));
    test::set_film(scene, 24, 24);
    return scene;
}

std::int32_t add_glass(Scene& scene, float eta, float alpha = 0) {
    DielectricMaterial glass;
    glass.eta = eta;
    if (alpha > 0) {
        glass.roughness.alpha_u = glass.roughness.alpha_v = FloatInput(alpha);
        glass.roughness.distribution = Microfacets::ggx;
    }
    return add_material(scene, rough(glass));
}

/// A glass block above what the camera sees: light refracts in and out.
TEST(LightsAgainstPath, ThroughGlassThatTheCameraDoesNotSee) {
    for (const float alpha : {0.0f, 0.2f}) {
        Scene scene = floor_and_lamp();
        test::add_shape(scene, test::box({-0.8f, 1.2f, -0.8f}, {0.8f, 1.8f, 0.8f}, false),
                        add_glass(scene, 1.5f, alpha));
        scene.camera = test::look_at({0, 0.9f, -2.2f}, {0, 0, 0}, {0, 1, 0}, 0.35f);
        Job job;
        job.integrator.max_depth = 8;
        expect_image_of_paths(scene, job, "alpha " + std::to_string(alpha), 124, 252);
    }
}

/// The camera is under water: there radiance is eta^2 of what it was, and power is not.
TEST(LightsAgainstPath, UnderWater) {
    for (const float alpha : {0.0f, 0.3f}) {
        Scene scene = floor_and_lamp();
        test::add_shape(scene, test::quad({-4, 1, -4}, {0, 0, 8}, {8, 0, 0}), add_glass(scene, 1.33f, alpha), Rgb(0.0f),
                        "water");
        scene.camera = test::look_at({0, 0.8f, -1.2f}, {0, 0, 0}, {0, 1, 0}, 0.35f);
        Job job;
        job.integrator.max_depth = 6;
        expect_image_of_paths(scene, job, "alpha " + std::to_string(alpha), 124, 252);
    }
}

/// A ball of few triangles with shading normals, and a floor whose normals lean: between the two cosines lies a factor.
TEST(LightsAgainstPath, ShadingNormals) {
    for (const bool strict : {false, true}) {
        Scene scene = floor_and_lamp();
        auto& floor = std::get<Mesh>(scene.shapes[0].geometry);
        for (const Vec3& lean : {Vec3(0.5f, 1, 0), Vec3(0, 1, 0.4f), Vec3(-0.5f, 1, 0), Vec3(0, 1, -0.4f)})
            floor.normals.push_back(normalize(lean));
        test::add_shape(scene, test::sphere_mesh({0.3f, 0.6f, 0.2f}, 0.6f, 1, true),
                        test::add_diffuse(scene, Rgb(0.8f)));
        scene.camera = test::look_at({0, 1.6f, -3.0f}, {0, 0.3f, 0}, {0, 1, 0}, 0.4f);
        Job job;
        job.integrator.strict_normals = strict;
        job.integrator.max_depth = 4;
        expect_image_of_paths(scene, job, strict ? "strict" : "not strict");
    }
}

TEST(LightsAgainstPath, EveryKindOfCameraAndFilter) {
    const auto with = [](const std::string& what, auto&& change) {
        Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
        test::set_film(scene, 24, 24);
        change(scene);
        expect_image_of_paths(scene, {}, what, 240, 240);
    };
    with("lens", [](Scene& s) {
        s.camera.corner *= 1.7f;
        s.camera.across *= 1.7f;
        s.camera.down *= 1.7f;
        s.camera.lens_u = Vec3(0.1f, 0, 0);
        s.camera.lens_v = Vec3(0, 0.1f, 0);
    });
    with("orthographic", [](Scene& s) {
        s.camera.across = Vec3(-0.9f, 0, 0);
        s.camera.down = Vec3(0, -0.9f, 0);
        s.camera.corner = Vec3(0.45f, 0.45f, 0);
        s.camera.parallel = Vec3(0, 0, 1);
    });
    with("panorama", [](Scene& s) {
        s.camera.origin = Vec3(0.5f, 0.75f, 0.3f);
        s.camera.corner = Vec3(0, 0, 1);
        s.camera.across = Vec3(1, 0, 0);
        s.camera.down = Vec3(0, 1, 0);
        s.camera.panoramic = true;
        s.film.filter = PixelFilter::tent;
        s.film.filter_radius = 1.0f;
    });
    with("window and wide filter", [](Scene& s) {
        s.film.filter = PixelFilter::gaussian;
        s.film.filter_radius = 2.0f;
        s.film.crop.x = 8;
        s.film.crop.y = 12;
        s.film.crop.whole_width = 48;
        s.film.crop.whole_height = 40;
    });
}

/// Whether the image's mean is that.
void expect_mean(const Rendered& image, double exact, const std::string& what, double noise = 0.02) {
    double mean = 0, variance = 0;
    const auto count = static_cast<double>(image.mean.pixels.size());
    for (std::size_t p = 0; p < image.mean.pixels.size(); ++p) {
        mean += double(image.mean.pixels[p].x) / count;
        variance += double(image.variance.pixels[p].x) / (count * count);
    }
    EXPECT_NEAR(mean, exact, 4 * std::sqrt(variance) + 1e-5 * exact) << what;
    EXPECT_LT(std::sqrt(variance), noise * exact) << what << ": nothing was tested";
}

/// Every technique on its own: what comes over so many edges is the albedo to their number less one.
TEST(Bidirectional, FurnaceByEachTechnique) {
    const float albedo = 0.8f;
    const Scene scene = test::furnace(albedo, 1.0f, 2.0f, Vec3(0.3f, -0.2f, 0.1f));
    for (int edges = 1; edges <= 4; ++edges)
        for (int light = 0; light <= edges; ++light) {
            if (edges == 1 && light == 1) continue;  // a lamp is not connected to the lens
            Job job;
            job.integrator.max_depth = edges;
            job.bidirectional.techniques = std::to_string(light) + "," + std::to_string(edges + 1 - light);
            job.bidirectional.weighted = false;
            expect_mean(render_light_paths(scene, job, "bidirectional", 7, 252), std::pow(double(albedo), edges - 1),
                        job.bidirectional.techniques, 0.04);
        }
}

/// Every technique on its own finds the light that next event alone finds.
TEST(Bidirectional, EachTechniqueFindsAllLightOfItsLength) {
    const Scene scene = small(test::cornell_box(1.0f, Vec3(0.0f)), 24, 24);
    const auto image = [&](int light, int camera, std::uint32_t spp) {
        Job job;
        job.integrator.max_depth = light + camera - 1;
        job.bidirectional.techniques = std::to_string(light) + "," + std::to_string(camera);
        job.bidirectional.weighted = false;
        return render_light_paths(scene, job, "bidirectional", 50 + static_cast<std::uint64_t>(light), spp);
    };
    for (int edges = 2; edges <= 4; ++edges) {
        const Rendered next_event = image(1, edges, 124);
        for (int light = 0; light <= edges; ++light)
            if (light != 1)
                expect_same_image(image(light, edges + 1 - light, 252), next_event,
                                  std::to_string(light) + "," + std::to_string(edges + 1 - light), 0.08);
    }
}

/// Weighted, they add up to the image, as every heuristic has it and whichever there are.
TEST(Bidirectional, WeightedTechniquesAddUp) {
    Scene scene = studio();
    test::add_shape(scene, Sphere{Vec3(-0.5f, 2.2f, -0.6f), 0.3f, false}, kNone, Rgb(8, 7, 6));
    scene.emitters.push_back({PointEmitter{{-0.8f, 2.0f, -0.5f}, Rgb(1.0f)}, {}});
    Job job;
    job.integrator.max_depth = 4;
    const Rendered path = render_light_paths(scene, job, "reference", 61, 60);
    for (const MisHeuristic mis : {MisHeuristic::balance, MisHeuristic::power})
        for (const bool light_image : {true, false})
            for (const bool next_event : {true, false}) {
                Job other = job;
                other.integrator.mis = mis;
                other.bidirectional.light_image = light_image;
                const std::string what =
                    std::to_string(int(mis)) + std::to_string(light_image) + std::to_string(next_event);
                expect_same_image(render_light_paths(scene, other, "bidirectional", 62, 60, next_event), path, what);
            }
    Rendered sum = path;
    std::fill(sum.mean.pixels.begin(), sum.mean.pixels.end(), Rgb(0.0f));
    std::fill(sum.variance.pixels.begin(), sum.variance.pixels.end(), Rgb(0.0f));
    for (int edges = 1; edges <= 4; ++edges)
        for (int light = 0; light <= edges; ++light) {
            if (edges == 1 && light == 1) continue;
            job.bidirectional.techniques = std::to_string(light) + "," + std::to_string(edges + 1 - light);
            const Rendered part =
                render_light_paths(scene, job, "bidirectional", 70 + static_cast<std::uint64_t>(9 * edges + light), 28);
            for (std::size_t p = 0; p < sum.mean.pixels.size(); ++p) {
                sum.mean.pixels[p] += part.mean.pixels[p];
                sum.variance.pixels[p] += part.variance.pixels[p];
            }
        }
    expect_same_image(sum, path, "sum");
}

TEST(Light, FurnaceHasTheExactMean) {
    for (const float albedo : {0.5f, 0.8f}) {
        const Scene scene = test::furnace(albedo, 1.0f, 2.0f, Vec3(0.3f, -0.2f, 0.1f));
        expect_mean(render_light_paths(scene, {}, "light", 5, 508), 1.0 / (1.0 - double(albedo)),
                    std::to_string(albedo));
        expect_mean(render_light_paths(scene, {}, "bidirectional", 6, 124), 1.0 / (1.0 - double(albedo)),
                    std::to_string(albedo));
    }
}

/// What an image says of its own variance is what replicas show. Not the lamp's own pixels: on so small a film each
/// gets a splat of every other path, where rare ones are expected.
void expect_variance_of_replicas(const char* type) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 12, 12);
    constexpr int kReplicas = 40;
    Job job;
    job.integrator.hide_emitters = true;
    std::vector<Rgb64> sum(scene.film.pixel_count(), Rgb64(0.0)), squares = sum;
    double said = 0;
    for (int r = 0; r < kReplicas; ++r) {
        const Rendered image = render_light_paths(scene, job, type, 100 + static_cast<std::uint64_t>(r), 28);
        for (std::size_t p = 0; p < sum.size(); ++p) {
            const Rgb64 mean(image.mean.pixels[p]);
            sum[p] += mean;
            squares[p] += mean * mean;
            said += double(average(image.variance.pixels[p])) / kReplicas;
        }
    }
    double shown = 0;
    for (std::size_t p = 0; p < sum.size(); ++p)
        for (int c = 0; c < 3; ++c)
            shown += (squares[p][c] - sum[p][c] * sum[p][c] / kReplicas) / (3 * (kReplicas - 1));
    EXPECT_NEAR(said / shown, 1.0, 0.15) << type;
}

TEST(Light, VarianceIsThatOfReplicas) {
    expect_variance_of_replicas("light");
}

TEST(Bidirectional, VarianceIsThatOfReplicas) {
    expect_variance_of_replicas("bidirectional");
}

}  // namespace
}  // namespace treefarm
