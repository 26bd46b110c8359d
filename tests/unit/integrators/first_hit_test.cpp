// SPDX-License-Identifier: Apache-2.0
// AOVs of scenes whose surfaces are known: what a camera ray meets, and what it sees in mirrors and glass.
#include "worker/integrators/first_hit/first_hit.h"

#include <gtest/gtest.h>

#include "common/plan/schedule/kernel.h"
#include "tests/support/aov_render.h"
#include "tests/support/local_render.h"

namespace treefarm {
namespace {

using test::add_diffuse;
using test::add_material;
using test::add_shape;
using test::one_pass;
using test::quad;
using test::wall_scene;

constexpr const char* kAll = test::kFirstHitAovs;

test::Layers render(const Scene& scene, const std::string& aovs, std::uint32_t spp = 16, const Job& job = {}) {
    return test::render_layers(scene, aovs, spp, job);
}

TEST(FirstHit, OfAPlaneIsKnown) {
    const Scene scene = wall_scene();
    const test::Layers image = render(scene, kAll);
    for (std::size_t p = 0; p < 64; ++p) {
        const Vec3 position = image.vector("position", p);
        EXPECT_NEAR(image["depth.Z"][p], 10.0f, 1e-4f) << "along the axis, not along the ray";
        EXPECT_NEAR(position.z, 10.0f, 1e-4f);
        EXPECT_GE(image["distance.Z"][p], position.length() * 0.99999f) << "a mean of lengths";
        EXPECT_NEAR(image["distance.Z"][p], position.length(), 0.02f);
        EXPECT_NEAR(image["uv.U"][p], (position.x + 5) / 10, 1e-4f);
        EXPECT_NEAR(image["uv.V"][p], (position.y + 5) / 10, 1e-4f);
        EXPECT_LT((image.vector("normal", p) - Vec3(0, 0, -1)).length(), 1e-6f);
        EXPECT_LT((image.vector("geometric_normal", p) - Vec3(0, 0, -1)).length(), 1e-6f);
        EXPECT_LT((image.vector("albedo", p, "RGB") - Vec3(0.1f, 0.2f, 0.7f)).length(), 1e-5f);
        EXPECT_EQ(image["A"][p], 1.0f);
        EXPECT_EQ(image["shape.I"][p], 1.0f);
        EXPECT_EQ(image["material.I"][p], 1.0f);
    }
    // Box filter: the mean of a pixel's points is where its centre's ray meets the wall, up to noise.
    const double half_pixel = 0.25 * 10 / 8;
    EXPECT_NEAR(std::abs(image["position.X"][0]), 7 * half_pixel, half_pixel);
    EXPECT_NEAR(image["position.Y"][0], 7 * half_pixel, half_pixel) << "rows run downwards";
}

TEST(FirstHit, NothingIsZeroAndItsFractionAlpha) {
    const Scene scene =
        wall_scene(1.0f);  // sees twice as far as the wall reaches: 2 of 8 pixels on each side are empty
    const test::Layers image = render(scene, kAll);
    for (const char* name : {"A", "albedo.B", "normal.Z", "depth.Z", "position.Z", "shape.I", "material.I", "uv.U"})
        EXPECT_EQ(image[name][0], 0.0f) << name;
    EXPECT_EQ(image["A"][3 * 8 + 3], 1.0f);
    // Pixels over the wall's edge (at 2 and 6 of 8 it lies between pixels): none here but by rounding.
    double sum = 0;
    for (const float alpha : image["A"])
        sum += static_cast<double>(alpha);
    EXPECT_NEAR(sum / 64, 0.25, 1e-3);
    EXPECT_NEAR(image["depth.Z"][3 * 8 + 3], 10.0f, 1e-4f);
}

TEST(FirstHit, AMaskIsThereAsOftenAsItIsOpaque) {
    Scene scene = wall_scene();
    scene.shapes.clear();
    Material half;
    half.bsdf = DiffuseMaterial{Rgb(0.5f)};
    half.twosided = true;
    half.opacity = FloatInput(0.5f);
    scene.materials.push_back(half);
    add_shape(scene, quad({-5, -5, 10}, {0, 10, 0}, {10, 0, 0}), static_cast<std::int32_t>(scene.materials.size()) - 1);
    const test::Layers image = render(scene, "alpha,depth", 256);
    double sum = 0;
    for (std::size_t p = 0; p < 64; ++p) {
        sum += static_cast<double>(image["A"][p]);
        EXPECT_NEAR(image["depth.Z"][p], 10.0f, 1e-3f) << "of the samples that met it alone";
    }
    EXPECT_NEAR(sum / 64, 0.5, 4 * 0.5 / std::sqrt(64.0 * 256));
}

/// A mirror at z = 10 shows the wall behind the camera, red, with the normal (0, 0, 1).
TEST(FirstHit, AMirrorShowsWhatItReflects) {
    Scene scene;
    const std::int32_t mirror = add_material(scene, ConductorMaterial{}), red = add_diffuse(scene, {0.8f, 0.1f, 0.1f});
    add_shape(scene, quad({-5, -5, 10}, {0, 10, 0}, {10, 0, 0}), mirror);
    add_shape(scene, quad({-50, -50, -5}, {100, 0, 0}, {0, 100, 0}), red);
    scene.camera = test::look_at(Vec3(0.0f), {0, 0, 1}, {0, 1, 0}, 0.25f);
    test::set_film(scene, 4, 4);
    scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
    const test::Layers image = render(scene, kAll);
    for (std::size_t p = 0; p < 16; ++p) {
        EXPECT_LT((image.vector("albedo", p, "RGB") - Vec3(0.8f, 0.1f, 0.1f)).length(), 1e-5f);
        EXPECT_LT((image.vector("normal", p) - Vec3(0, 0, 1)).length(), 1e-6f);
        EXPECT_LT((image.vector("geometric_normal", p) - Vec3(0, 0, -1)).length(), 1e-6f) << "the mirror's own";
        EXPECT_NEAR(image["depth.Z"][p], 10.0f, 1e-4f) << "the mirror's own";
        EXPECT_EQ(image["shape.I"][p], 1.0f);
        EXPECT_EQ(image["A"][p], 1.0f);
    }
}

/// Through a pane of glass, and in it, nothing but a blue wall is to be seen, or nothing at all.
TEST(FirstHit, GlassShowsWhatIsBehindIt) {
    Scene scene = wall_scene();
    const std::int32_t glass = add_material(scene, DielectricMaterial{});
    add_shape(scene, test::box({-4, -4, 6}, {4, 4, 7}, false), glass);
    const test::Layers image = render(scene, kAll, 256);
    double blue = 0;
    for (std::size_t p = 0; p < 64; ++p) {
        const Vec3 albedo = image.vector("albedo", p, "RGB"), normal = image.vector("normal", p);
        EXPECT_NEAR(image["depth.Z"][p], 6.0f, 1e-4f) << "the glass is the first surface";
        EXPECT_EQ(image["A"][p], 1.0f) << "and counts as opaque";
        EXPECT_EQ(image["shape.I"][p], 2.0f);
        EXPECT_LT((albedo - Vec3(0.1f, 0.2f, 0.7f) * -normal.z).length(), 1e-5f) << "both of the same surfaces";
        blue += static_cast<double>(-normal.z) / 64;
    }
    // Of light that falls at right angles two sides of glass let (1 - R) / (1 + R) pass, R = ((n - 1) / (n + 1))^2.
    const double r = std::pow(0.5046 / 2.5046, 2);
    EXPECT_NEAR(blue, (1 - r) / (1 + r), 0.02);
}

TEST(FirstHit, ASurfaceThatIsPartlyAMirrorIsItsOwn) {
    Scene scene = wall_scene();
    PlasticMaterial plastic;
    plastic.diffuse_reflectance = Rgb(0.5f);
    scene.materials[0].bsdf = plastic;
    const test::Layers image = render(scene, "albedo,normal");
    for (std::size_t p = 0; p < 64; ++p) {
        EXPECT_LT((image.vector("normal", p) - Vec3(0, 0, -1)).length(), 1e-6f);
        EXPECT_GT(image["albedo.G"][p], 0.3f);
        EXPECT_LE(image["albedo.G"][p], 1.0f);
        EXPECT_NEAR(image["albedo.G"][p], image["albedo.G"][0], 0.02f) << "no noise";
    }
}

TEST(FirstHit, CropWindowsShowThePartOfTheWhole) {
    Scene whole = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(whole, 24, 16);
    Scene part = whole;
    part.film.crop = {9, 3, 24, 16};
    part.film.width = 11;
    part.film.height = 7;
    const test::Layers a = render(whole, kAll, 6), b = render(part, kAll, 6);
    ASSERT_EQ(a.channels.size(), b.channels.size());
    for (std::size_t c = 0; c < a.channels.size(); ++c)
        for (std::size_t y = 0; y < 7; ++y)
            for (std::size_t x = 0; x < 11; ++x)
                EXPECT_EQ(b.channels[c].values[y * 11 + x], a.channels[c].values[(y + 3) * 24 + x + 9])
                    << a.channels[c].name << " " << x << ", " << y;
}

/// Direct light is the image of paths of two edges, and what is left of the whole is the rest, for each pixel.
TEST(DirectLight, IsTheImageOfPathsOfTwoEdges) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    add_material(scene, DielectricMaterial{});
    add_shape(scene, test::box({0.3f, 0.1f, 0.1f}, {0.5f, 0.3f, 0.2f}, false), 3);
    test::set_film(scene, 12, 12);
    for (const NextEvent next_event : {NextEvent::always, NextEvent::never}) {
        Job job;
        job.integrator.next_event = next_event;
        const test::Layers whole = render(scene, "direct,indirect", 32, job);
        job.integrator.max_depth = 2;
        const test::Layers direct = render(scene, "direct,indirect", 32, job);
        for (std::size_t p = 0; p < 144; ++p)
            for (int half = 0; half < 2; ++half) {
                EXPECT_EQ(whole.direct[p].half[half].mean, direct.pixels[p].half[half].mean) << p;
                EXPECT_EQ(whole.direct[p].half[half].m2, direct.pixels[p].half[half].m2) << p;
            }
        double indirect = 0;
        for (std::size_t p = 0; p < 144; ++p) {
            const Vec3 mean(whole.pixels[p].whole().mean);
            const Vec3 sum = whole.vector("direct", p, "RGB") + whole.vector("indirect", p, "RGB");
            EXPECT_LE((sum - mean).length(), 4e-7f * mean.length()) << p;
            EXPECT_GE(whole["indirect.R"][p], -1e-5f) << "each sample has its direct part, and more";
            EXPECT_EQ(direct["indirect.R"][p], 0.0f);
            indirect += static_cast<double>(whole["indirect.R"][p]);
        }
        EXPECT_GT(indirect, 1.0);
    }
}

/// Guided, with paths that are split and roulette by what the tree expects: neither comes before the second edge, so no
/// sample has less light than its direct part.
TEST(DirectLight, IsPartOfEachGuidedSample) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 16, 16);
    Job job;
    job.guiding.type = GuidingType::automatic;
    job.guiding.rule = Rule::always;
    job.guiding.splitting = 32;
    job.guiding.spatial_threshold = 100;
    job.budget.spp = 127;
    const test::LocalRender learned = test::render_locally(scene, job);
    ASSERT_TRUE(learned.tree().trained);
    job.output.aovs = "direct";
    const Resolved resolved = resolve(job, scene);
    const RenderUnit renderer = make_renderer(scene, resolved);
    const SdTreeSampler guide(learned.tree());
    for (const bool next_event : {true, false}) {
        PassPlan pass = one_pass(8);
        pass.index = 3;
        pass.guided = pass.record = pass.split = true;
        pass.next_event = next_event;
        pass.kernel = kernel_of(resolved, pass, facts_of(learned.tree()));
        UnitOutput output;
        output.begin(AnySampler(guide));
        renderer(pass, guide, {3, 0, 0, 16, 16, 0}, output);
        EXPECT_GT(output.log.of<SdTreeGuide>().records.size(), 0u) << "the direct part must not take the records along";
        EXPECT_GT(output.stats.split_path_rays, 0u) << "the test must exercise splitting";
        for (std::size_t p = 0; p < 256; ++p) {
            const Rgb64 whole = output.pixels[p].whole().mean, direct = output.aovs.direct[p].whole().mean;
            EXPECT_GE(whole.x - direct.x, -1e-6 * whole.x) << p;
            EXPECT_GE(whole.z - direct.z, -1e-6 * whole.z) << p;
        }
    }
}

/// The wall with a normal map that tilts it towards +x everywhere, as Mitsuba's texels say.
Scene tilted_wall() {
    Scene scene = wall_scene();
    const Rgb texel(0.8f, 0.5f, 0.9f);
    scene.textures.push_back({CheckerboardTexture{texel, texel, {}}, "", {}});
    scene.materials[0].detail.normal_map = 0;
    return scene;
}

TEST(FirstHit, NormalsAreThoseOfShadingAndAlbedosAreFlat) {
    const Vec3 tilted(0.6f, 0, -0.8f), flat(0, 0, -1);
    Scene scene = tilted_wall();
    const auto expect_normal = [&](const Vec3& expected, const char* what) {
        const test::Layers image = render(scene, "normal,geometric_normal,albedo", 4);
        for (const std::size_t p : {0u, 27u, 63u}) {
            EXPECT_LT((image.vector("normal", p) - expected).length(), 1e-5f) << what << image.vector("normal", p);
            EXPECT_LT((image.vector("geometric_normal", p) - flat).length(), 1e-6f) << what;
        }
        return image.vector("albedo", 27, "RGB");
    };
    EXPECT_LT((expect_normal(tilted, "tilted") - Vec3(0.1f, 0.2f, 0.7f)).length(), 1e-5f);
    CoatingMaterial coat;
    coat.coated = 0;
    scene.shapes[0].material = add_material(scene, coat);
    expect_normal(tilted, "below a coat");
    scene.shapes[0].material =
        add_material(scene, BlendMaterial{FloatInput(0.5f), 0, add_diffuse(scene, Rgb(0.5f), true)});
    const Vec3 albedo = expect_normal(normalize(tilted + flat), "half of a blend");
    EXPECT_LT((albedo - Vec3(0.3f, 0.35f, 0.6f)).length(), 1e-3f) << albedo;
}

TEST(NormalsIntegrator, ShowsTheNormalsOfShading) {
    Scene scene = tilted_wall();
    Job job;
    job.integrator.type = "normals";
    const Rgb64 tilted = render(scene, "", 1, job).pixels[27].whole().mean;
    EXPECT_NEAR(tilted.x, 0.8, 1e-5);
    EXPECT_NEAR(tilted.z, 0.1, 1e-5);
    scene.materials[0].detail = {};
    EXPECT_NEAR(render(scene, "", 1, job).pixels[27].whole().mean.x, 0.5, 1e-6);
}

TEST(FirstHit, LeavesTheImageAndItsCountsAlone) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 12, 12);
    const test::Layers plain = render(scene, ""), layered = render(scene, std::string(kAll) + ",direct,spp");
    for (std::size_t p = 0; p < 144; ++p)
        EXPECT_EQ(plain.pixels[p].whole().mean, layered.pixels[p].whole().mean);
    EXPECT_EQ(plain.stats.rays, layered.stats.rays);
    EXPECT_EQ(plain.stats.paths, layered.stats.paths);
}

}  // namespace
}  // namespace treefarm
