// SPDX-License-Identifier: Apache-2.0
#include "common/config/job_reader.h"
#include "tests/support/mitsuba_fixture.h"
#include "tests/support/support.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

using Mitsuba = MitsubaFixture;

TEST_F(Mitsuba, CameraHasXToTheLeft) {
    const auto loaded = load(
        "<sensor type=\"perspective\"><float name=\"fov\" value=\"90\"/><transform name=\"toWorld\">"
        "<lookAt origin=\"0, 0, 0\" target=\"0 0 1\" up=\"0,1,0\"/></transform></sensor>");
    const Camera& camera = loaded.scene.camera;
    expect_near(direction(camera, 0.5f, 0.5f), Vec3(0, 0, 1));
    EXPECT_GT(direction(camera, 0.0f, 0.5f).x, 0.7f) << "+x must appear at the left edge";
    EXPECT_LT(direction(camera, 1.0f, 0.5f).x, -0.7f);
    EXPECT_GT(direction(camera, 0.5f, 0.0f).y, 0.5f) << "+y must appear at the upper edge";
    expect_near(camera.corner, Vec3(1.0f, 0.75f, 1.0f));
}

TEST_F(Mitsuba, FieldOfViewAlongEachAxis) {
    const auto half_angles = [&](const std::string& axis, int width, int height) {
        const auto loaded =
            load(sensor("<float name=\"fov\" value=\"60\"/><string name=\"fov_axis\" value=\"" + axis + "\"/>", width,
                        height),
                 "3.0.0");
        return loaded.scene.camera.corner;
    };
    const float tangent = std::tan(static_cast<float>(M_PI) / 6.0f);
    expect_near(half_angles("x", 200, 100), Vec3(tangent, tangent / 2, 1));
    expect_near(half_angles("y", 200, 100), Vec3(2 * tangent, tangent, 1));
    expect_near(half_angles("smaller", 200, 100), Vec3(2 * tangent, tangent, 1));
    expect_near(half_angles("larger", 200, 100), Vec3(tangent, tangent / 2, 1));
    expect_near(half_angles("smaller", 100, 200), Vec3(tangent, 2 * tangent, 1));
    const Vec3 diagonal = half_angles("diagonal", 300, 400);
    EXPECT_NEAR(std::hypot(diagonal.x, diagonal.y), tangent, 1e-5f);
    const Vec3 lens = load(sensor("<string name=\"focalLength\" value=\"50mm\"/>", 36, 24)).scene.camera.corner;
    expect_near(lens, Vec3(18.0f / 50.0f, 12.0f / 50.0f, 1.0f));
}

TEST_F(Mitsuba, PrincipalPointMovesTheImage) {
    const auto loaded = load(
        sensor("<float name=\"fov\" value=\"90\"/><float name=\"principal_point_offset_x\" value=\"0.25\"/>"), "3.0.0");
    expect_near(direction(loaded.scene.camera, 0.25f, 0.5f), Vec3(0, 0, 1));
}

TEST_F(Mitsuba, FilmSizeFromOutsideChangesTheCamera) {
    const auto path =
        write("s.xml", "<scene version=\"3.0.0\">" + sensor("<float name=\"fov\" value=\"90\"/>") + "</scene>");
    const auto loaded = load_scene(path, {}, false, 100, 0);
    EXPECT_EQ(loaded.scene.film.width, 100);
    EXPECT_EQ(loaded.scene.film.height, 100);
    expect_near(loaded.scene.camera.corner, Vec3(1, 1, 1));
}

TEST_F(Mitsuba, DefaultsAndDefines) {
    const std::string body =
        "<default name=\"w\" value=\"10\"/><default name=\"ww\" value=\"20\"/><sensor type=\"perspective\"><film "
        "type=\"hdrfilm\">"
        "<integer name=\"width\" value=\"$ww\"/><integer name=\"height\" value=\"1$w\"/></film></sensor>";
    EXPECT_EQ(load(body).scene.film.width, 20);
    EXPECT_EQ(load(body).scene.film.height, 110);
    EXPECT_EQ(load(body, "3.0.0", {{"ww", "30"}}).scene.film.width, 30);
    EXPECT_THROW(load(body, "3.0.0", {{"www", "30"}}), InputError);
    EXPECT_THROW(load("<sensor type=\"$missing\"/>"), InputError);
}

TEST_F(Mitsuba, IncludesAreRelativeToTheirFile) {
    write("sub/parts.xml",
          "<scene version=\"0.6.0\"><default name=\"x\" value=\"9\"/><bsdf type=\"diffuse\" id=\"b\"/>"
          "<include filename=\"more.xml\"/></scene>");
    write("sub/more.xml",
          "<scene version=\"0.6.0\"><shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/><ref id=\"b\"/>"
          "</shape></scene>");
    write("sub/m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto loaded = load_with_sensor("<include filename=\"sub/parts.xml\"/>");
    EXPECT_EQ(mesh_of(loaded).triangle_count(), 1u);
    EXPECT_EQ(loaded.scene.shapes[0].where.file, (folder_ / "sub/more.xml").string());
}

TEST_F(Mitsuba, IncludedFilesKeepTheirVersion) {
    const std::string spectrum = "<spectrum name=\"radiance\" value=\"400:1, 700:9\"/>";
    const auto lamp = [](const std::string& radiance) {
        return "<shape type=\"rectangle\"><emitter type=\"area\">" + radiance + "</emitter></shape>";
    };
    write("old.xml", "<scene version=\"0.5.0\">" + lamp(spectrum) + "</scene>");
    const auto loaded = load_with_sensor("<include filename=\"old.xml\"/>" + lamp(spectrum), "0.6.0");
    const auto radiance = [&](std::size_t i) {
        return std::get<AreaEmitter>(loaded.scene.emitters.at(i).kind).radiance.value;
    };
    EXPECT_GT((radiance(0) - radiance(1)).length(), 0.5f) << "version 0.5 interpolates backwards";
    EXPECT_EQ(radiance(1),
              std::get<AreaEmitter>(load_with_sensor(lamp(spectrum)).scene.emitters.at(0).kind).radiance.value);
}

TEST_F(Mitsuba, FiltersOfTheFilm) {
    const auto film = [&](const std::string& filter) {
        return load("<sensor type=\"perspective\"><film type=\"hdrfilm\">" + filter + "</film></sensor>").scene.film;
    };
    EXPECT_EQ(film("").width, 768);
    EXPECT_EQ(film("").height, 576);
    EXPECT_EQ(film("").filter, PixelFilter::gaussian);
    EXPECT_EQ(film("").filter_radius, 2.0f);
    EXPECT_EQ(film("<rfilter type=\"box\"/>").filter, PixelFilter::box);
    EXPECT_EQ(film("<rfilter type=\"box\"/>").filter_radius, 0.5f);
    EXPECT_EQ(film("<rfilter type=\"tent\"/>").filter_radius, 1.0f);
    EXPECT_EQ(film("<rfilter type=\"gaussian\"><float name=\"stddev\" value=\"0.25\"/></rfilter>").filter_stddev,
              0.25f);
    EXPECT_EQ(film("<boolean name=\"banner\" value=\"false\"/><string name=\"pixelFormat\" value=\"rgba\"/>").width,
              768);
}

TEST_F(Mitsuba, IntegratorsBecomeSettings) {
    Job job;
    apply_layer(
        job, load_with_sensor(
                 "<integrator type=\"path\"><integer name=\"maxDepth\" value=\"7\"/>"
                 "<integer name=\"rrDepth\" value=\"3\"/><boolean name=\"hideEmitters\" value=\"true\"/></integrator>")
                 .settings);
    EXPECT_EQ(job.guiding.type, Job().guiding.type) << "how light is transported, not that nothing may guide";
    EXPECT_EQ(job.integrator.next_event, NextEvent::automatic);
    EXPECT_EQ(job.integrator.max_depth, 7);
    EXPECT_EQ(job.integrator.rr_depth, 3);
    EXPECT_TRUE(job.integrator.hide_emitters);

    const std::string guided = "<string name=\"budgetType\" value=\"spp\"/><float name=\"budget\" value=\"127\"/>";
    Job paper;
    apply_layer(paper,
                load("<sensor type=\"perspective\"><sampler type=\"sobol\"><integer name=\"sampleCount\" value=\"4\"/>"
                     "<integer name=\"seed\" value=\"5\"/></sampler></sensor><integrator type=\"guided_path\">" +
                     guided + "</integrator>")
                    .settings);
    EXPECT_EQ(paper.guiding.type, GuidingType::ppg);
    EXPECT_EQ(paper.guiding.preset, "paper");
    EXPECT_EQ(paper.integrator.next_event, NextEvent::never);
    EXPECT_EQ(paper.guiding.combination, Combination::last);
    EXPECT_EQ(paper.budget.spp, 127u) << "the integrator's budget wins over the sampler's";
    EXPECT_EQ(paper.sampler.seed, 5u);

    Job other;
    apply_layer(other,
                load_with_sensor(
                    "<integrator type=\"guided_path\">" + guided +
                    "<string name=\"nee\" value=\"kickstart\"/><integer name=\"sTreeThreshold\" value=\"4000\"/>"
                    "<float name=\"dTreeThreshold\" value=\"0.02\"/><integer name=\"sppPerPass\" value=\"1\"/>"
                    "<float name=\"bsdfSamplingFraction\" value=\"0.25\"/><boolean name=\"dumpSDTree\" value=\"true\"/>"
                    "<string name=\"sampleCombination\" value=\"inversevar\"/>"
                    "<string name=\"spatialFilter\" value=\"nearest\"/><integer name=\"sdTreeMaxMemory\" value=\"-1\"/>"
                    "<string name=\"bsdfSamplingFractionLoss\" value=\"none\"/></integrator>")
                    .settings);
    EXPECT_EQ(other.integrator.next_event, NextEvent::kickstart);
    EXPECT_EQ(other.guiding.spatial_threshold, 4000);
    EXPECT_EQ(other.guiding.directional_threshold, 0.02f);
    EXPECT_EQ(other.guiding.spp_unit, 1);
    EXPECT_EQ(other.guiding.bsdf_fraction, 0.25f);
    EXPECT_EQ(other.guiding.combination, Combination::inverse_variance);
}

TEST_F(Mitsuba, LenientReadingApproximatesAndWarns) {
    const std::string body =
        "<sensor type=\"perspective\"/><integrator type=\"mlt\"/><medium type=\"homogeneous\" id=\"fog\"/>"
        "<bsdf type=\"hair\" id=\"unused\"/>"
        "<bsdf type=\"irawan\" id=\"old\"><float name=\"repeatU\" value=\"15\"/></bsdf>"
        "<bsdf type=\"twosided\" id=\"both\"><bsdf type=\"irawan\"/></bsdf>"
        "<shape type=\"hair\"/><shape type=\"rectangle\"><ref id=\"old\"/><float name=\"unknown\" "
        "value=\"1\"/></shape>"
        "<shape type=\"rectangle\"><ref id=\"both\"/></shape><emitter type=\"projector\"/><mystery/>";
    EXPECT_THROW(load(body), InputError);
    const auto loaded = load(body, "0.6.0", {}, true);
    EXPECT_EQ(loaded.scene.shapes.size(), 2u);
    EXPECT_EQ(std::get<DiffuseMaterial>(loaded.scene.materials[0].bsdf).reflectance, Rgb(0.5f));
    EXPECT_TRUE(loaded.scene.materials[1].twosided);
    // integrator, two BSDFs, hair, the property, projector, mystery, and that there is no emitter; not what is unused
    EXPECT_EQ(loaded.warnings.size(), 8u);
    for (const Warning& warning : loaded.warnings)
        EXPECT_EQ(warning.text().find((folder_ / "scene.xml").string()), 0u) << warning.text();
}

TEST_F(Mitsuba, WhatIsNotSimulatedIsNamed) {
    const auto message = [&](const std::string& body) {
        try {
            load_with_sensor(body);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("read without complaint");
    };
    const auto named = [&](const std::string& body, const std::string& effect) {
        EXPECT_NE(message(body).find(effect), std::string::npos) << message(body);
    };
    named("<shape type=\"rectangle\"><medium name=\"interior\" type=\"homogeneous\"/></shape>", "medium");
    named("<shape type=\"rectangle\"><subsurface type=\"dipole\"/></shape>", "below surfaces");
    named("<shape type=\"rectangle\"><animation name=\"toWorld\"><transform time=\"0\"/></animation></shape>",
          "motion");
    named("<shape type=\"rectangle\"><bsdf type=\"hair\"/></shape>", "hair fibres");
    named("<shape type=\"rectangle\"><bsdf type=\"polarizer\"/></shape>", "polarisation");
}

TEST_F(Mitsuba, BothSpellingsMeanTheSame) {
    const auto old = load(
        "<sensor type=\"perspective\"><float name=\"nearClip\" value=\"1\"/><string name=\"fovAxis\" value=\"y\"/>"
        "<float name=\"fov\" value=\"30\"/></sensor>");
    const auto recent = load(
        "<sensor type=\"perspective\"><float name=\"near_clip\" value=\"1\"/><string name=\"fov_axis\" value=\"y\"/>"
        "<float name=\"fov\" value=\"30\"/></sensor>",
        "3.0.0");
    EXPECT_EQ(old.scene.camera.corner, recent.scene.camera.corner);
}

TEST_F(Mitsuba, OwnScenesAreStrictlyReadable) {
    for (const char* name : {"cornell-box.xml", "white-furnace.xml", "door-ajar.xml"}) {
        const auto loaded = load_scene(test::own_scene(name));
        EXPECT_TRUE(loaded.warnings.empty()) << name;
        EXPECT_FALSE(loaded.scene.shapes.empty()) << name;
        EXPECT_FALSE(loaded.scene.emitters.empty()) << name;
    }
}

TEST_F(Mitsuba, SharedCornellBox) {
    const std::string path = test::shared_scene("cbox/cbox.xml");
    if (path.empty()) GTEST_SKIP() << "../shared/scenes is not here";
    const auto loaded = load_scene(path);
    const Scene& scene = loaded.scene;
    EXPECT_TRUE(loaded.warnings.empty());
    EXPECT_EQ(scene.triangle_count(), 36u);
    EXPECT_EQ(scene.film.width, 512);
    EXPECT_EQ(scene.film.filter, PixelFilter::box);
    expect_near(scene.camera.origin, Vec3(278, 273, -800));
    EXPECT_NEAR(scene.camera.corner.x, std::tan(39.3077 / 2 * M_PI / 180), 1e-5);
    const auto white = std::get<DiffuseMaterial>(scene.materials[1].bsdf).reflectance;
    EXPECT_EQ(scene.materials[1].name, "white");
    // Integrated independently from tables at 1 nm, interpolated as Mitsuba 0.5 does it.
    expect_near(white.value, Vec3(0.885757f, 0.698917f, 0.666394f), 1e-4f);
    expect_near(std::get<DiffuseMaterial>(scene.materials[2].bsdf).reflectance.value,
                Vec3(0.570062f, 0.043032f, 0.044359f), 1e-4f);
    const auto& lamp = std::get<AreaEmitter>(scene.emitters[0].kind);
    expect_near(lamp.radiance.value, Vec3(36.772107f, 21.976540f, 5.506947f), 2e-3f);
    const Mesh& mesh = std::get<Mesh>(scene.shapes[static_cast<std::size_t>(lamp.shape)].geometry);
    expect_near(triangle_normal(mesh, 0), Vec3(0, 1, 0));
    Job job;
    apply_layer(job, loaded.settings);
    EXPECT_EQ(job.budget.spp, 127u);
    EXPECT_EQ(job.integrator.max_depth, 10);
    EXPECT_TRUE(job.integrator.strict_normals);
}

TEST_F(Mitsuba, SharedScenesAreStrictlyReadable) {
    for (const char* name : {"spaceship/spaceship.xml", "kitchen/kitchen.xml", "kitchen/kitchen-envmap.xml"}) {
        const std::string path = test::shared_scene(name);
        if (path.empty()) GTEST_SKIP() << "../shared/scenes is not here";
        const Scene scene = load_scene(path).scene;
        EXPECT_GT(scene.triangle_count(), 200000u) << name;
        EXPECT_FALSE(scene.emitters.empty()) << name;
        for (const TextureImage& image : scene.images)
            EXPECT_FALSE(image.bytes.empty() && image.floats.empty()) << image.name;
    }
}

}  // namespace
}  // namespace treefarm
