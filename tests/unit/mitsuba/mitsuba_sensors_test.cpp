// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "common/config/job_reader.h"
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

class MitsubaSensors : public MitsubaFixture {
  protected:
    Camera thin_lens(const std::string& inside, const std::string& version = "0.6.0") const {
        return load("<sensor type=\"thinlens\"><float name=\"fov\" value=\"90\"/>" + inside + "</sensor>", version)
            .scene.camera;
    }
};

TEST_F(MitsubaSensors, ThinLensesAreSharpAtTheirFocus) {
    const std::string moved =
        "<transform name=\"toWorld\"><rotate y=\"1\" angle=\"90\"/><translate x=\"5\"/></transform>";
    const Camera camera = thin_lens(
        "<float name=\"apertureRadius\" value=\"0.25\"/>"
        "<float name=\"focusDistance\" value=\"4\"/>" +
        moved);
    EXPECT_TRUE(camera.has_lens());
    expect_near(camera.origin, Vec3(5, 0, 0));
    const Vec3 focus = camera.origin + camera.corner + camera.across * 0.5f + camera.down * 0.5f;
    expect_near(focus, Vec3(9, 0, 0), 1e-4f);
    EXPECT_NEAR(camera.across.length(), 8.0f, 1e-4f) << "90 degrees at a distance of 4";
    EXPECT_NEAR(camera.lens_u.length(), 0.25f, 1e-6f);
    EXPECT_NEAR(dot(camera.lens_u, camera.lens_v), 0.0f, 1e-6f);
    EXPECT_NEAR(dot(camera.lens_u, Vec3(1, 0, 0)), 0.0f, 1e-6f) << "the lens faces the scene";
    // The direction of each film position is the pinhole's.
    const Camera pinhole =
        load("<sensor type=\"perspective\"><float name=\"fov\" value=\"90\"/>" + moved + "</sensor>").scene.camera;
    EXPECT_FALSE(pinhole.has_lens());
    expect_near(direction(camera, 0.2f, 0.7f), direction(pinhole, 0.2f, 0.7f));
}

TEST_F(MitsubaSensors, MalformedLensesAreRefused) {
    EXPECT_THROW(thin_lens(""), InputError) << "no aperture";
    EXPECT_THROW(thin_lens("<float name=\"apertureRadius\" value=\"-1\"/>"), InputError);
    EXPECT_THROW(
        thin_lens("<float name=\"aperture_radius\" value=\"1\"/><float name=\"focus_distance\" value=\"0\"/>", "3.0.0"),
        InputError);
    EXPECT_FALSE(thin_lens("<float name=\"apertureRadius\" value=\"0\"/>").has_lens());
    EXPECT_THROW(load("<sensor type=\"perspective\"><float name=\"apertureRadius\" value=\"1\"/></sensor>", "3.0.0"),
                 InputError);
}

TEST_F(MitsubaSensors, OtherSensorsAndFilms) {
    EXPECT_THROW(load("<sensor type=\"irradiancemeter\"/>"), InputError);
    const std::string film = "<integer name=\"width\" value=\"30\"/><integer name=\"height\" value=\"20\"/>";
    const auto ldr = load("<sensor type=\"perspective\"><film type=\"ldrfilm\">" + film +
                          "<float name=\"gamma\" value=\"2.2\"/></film></sensor>");
    EXPECT_EQ(ldr.scene.film.width, 30);
    EXPECT_EQ(ldr.warnings.at(0).text().find("ldrfilm") != std::string::npos, true);
    EXPECT_THROW(load("<sensor type=\"perspective\"><film type=\"mfilm\">" + film + "</film></sensor>"), InputError);
    const auto open = load("<sensor type=\"perspective\"><float name=\"shutterClose\" value=\"1\"/></sensor>");
    EXPECT_NE(open.warnings.at(0).text().find("motion"), std::string::npos);
}

std::string view(const std::string& id, double fov) {
    return "<sensor type=\"perspective\"" + (id.empty() ? "" : " id=\"" + id + "\"") + "><float name=\"fov\" value=\"" +
           std::to_string(fov) + "\"/></sensor>\n";
}

TEST_F(MitsubaSensors, OneOfSeveralIsUsed) {
    const std::string views = view("", 20) + view("side", 60) + view("0", 90);
    const auto width = [&](const std::string& version, const std::string& wanted = "") {
        const auto path = write("views.xml", "<scene version=\"" + version + "\">" + views + "</scene>");
        return load_scene(path, {}, false, 0, 0, wanted).scene.camera.across.length();
    };
    const auto of_fov = [](double degrees) { return 2.0 * std::tan(degrees * M_PI / 360.0); };
    EXPECT_NEAR(width("3.0.0"), of_fov(20), 1e-5);
    EXPECT_NEAR(width("2.1.0"), of_fov(20), 1e-5);
    EXPECT_NEAR(width("0.6.0"), of_fov(90), 1e-5);
    EXPECT_NEAR(width("3.0.0", "1"), of_fov(60), 1e-5);
    EXPECT_NEAR(width("0.6.0", "side"), of_fov(60), 1e-5);
    EXPECT_NEAR(width("3.0.0", "0"), of_fov(90), 1e-5) << "an id comes before a number";
    for (const char* wanted : {"3", "-1", "sid", " "})
        EXPECT_THROW(width("3.0.0", wanted), InputError) << wanted;
    try {
        width("3.0.0", "top");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("0, 1 (\"side\"), 2 (\"0\")"), std::string::npos) << error.what();
    }
    const auto notes = load(views, "3.0.0").notes;
    ASSERT_FALSE(notes.empty());
    EXPECT_NE(notes[0].text().find("first of 3 sensors"), std::string::npos) << notes[0].text();
    const auto checked = load_scene_to_check(folder_ / "scene.xml").findings;
    ASSERT_EQ(checked.size(), 1u);
    EXPECT_EQ(checked[0].severity, Finding::Severity::note);
    EXPECT_TRUE(load_scene_to_check(folder_ / "scene.xml", {}, false, "1").findings.empty()) << "chosen";
}

TEST_F(MitsubaSensors, OrthographicOnesScale) {
    const auto ortho = [&](const std::string& transform, const std::string& film = "") {
        return load("<sensor type=\"orthographic\"><transform name=\"toWorld\">" + transform + "</transform>" + film +
                    "<float name=\"nearClip\" value=\"1\"/><float name=\"farClip\" value=\"10\"/></sensor>")
            .scene.camera;
    };
    const Camera camera = ortho("<scale x=\"2\" y=\"3\"/><lookat origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"/>",
                                "<film type=\"hdrfilm\"><integer name=\"width\" value=\"200\"/><integer "
                                "name=\"height\" value=\"100\"/></film>");
    EXPECT_TRUE(camera.is_orthographic());
    expect_near(camera.origin, Vec3(0, 0, 4));
    expect_near(camera.parallel, Vec3(0, 0, -1));
    // Mitsuba's film sees [-1, 1] across, and what its shape makes of that upwards.
    expect_near(camera.origin + camera.corner, Vec3(-2, 1.5, 4));
    expect_near(camera.across, Vec3(4, 0, 0));
    expect_near(camera.down, Vec3(0, -3, 0));
    EXPECT_NEAR(ortho("<scale value=\"7\"/>").parallel.length(), 1.0f, 1e-6f);
    EXPECT_THROW(ortho("<scale x=\"0\" y=\"1\" z=\"1\"/>"), InputError);
    EXPECT_FALSE(load("<sensor type=\"perspective\"/>").scene.camera.is_orthographic());
}

TEST_F(MitsubaSensors, SphericalOnesSeeAllDirections) {
    const auto panorama = [&](const std::string& transform) {
        return load("<sensor type=\"spherical\"><transform name=\"toWorld\">" + transform + "</transform></sensor>")
            .scene.camera;
    };
    const Camera camera = panorama("<lookat origin=\"1,2,3\" target=\"1,2,9\" up=\"0,1,0\"/>");
    EXPECT_TRUE(camera.panoramic);
    expect_near(camera.origin, Vec3(1, 2, 3));
    // Longitude as Mitsuba 0.6 has it: the middle of the film is what the camera looks at, its edges are behind.
    expect_near(camera.panorama_direction(0.5f, 0.5f), Vec3(0, 0, 1));
    expect_near(camera.panorama_direction(0.0f, 0.5f), Vec3(0, 0, -1));
    expect_near(camera.panorama_direction(0.25f, 0.5f), Vec3(1, 0, 0));
    expect_near(camera.panorama_direction(0.3f, 0.0f), Vec3(0, 1, 0));
    expect_near(camera.panorama_direction(0.3f, 1.0f), Vec3(0, -1, 0));
    EXPECT_THROW(panorama("<scale value=\"2\"/>"), InputError);
}

class Films : public MitsubaFixture {
  protected:
    static std::string integers(const std::vector<std::pair<std::string, int>>& values) {
        std::string text;
        for (const auto& [name, value] : values)
            text += "<integer name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
        return text;
    }

    Film film(const std::string& inside, int width = 0, int height = 0, const std::string& version = "3.0.0") const {
        const auto path = write("film.xml", "<scene version=\"" + version +
                                                "\"><sensor type=\"perspective\"><film type=\"hdrfilm\">" + inside +
                                                "</film></sensor></scene>");
        return load_scene(path, {}, false, width, height).scene.film;
    }
};

TEST_F(Films, CropWindows) {
    const std::string size = integers({{"width", 40}, {"height", 30}});
    const std::string window =
        integers({{"crop_offset_x", 8}, {"crop_offset_y", 5}, {"crop_width", 16}, {"crop_height", 10}});
    const Film cropped = film(size + window);
    EXPECT_EQ(cropped.width, 16);
    EXPECT_EQ(cropped.height, 10);
    EXPECT_EQ(cropped.crop, (CropWindow{8, 5, 40, 30}));
    const Film old = film(integers({{"width", 40},
                                    {"height", 30},
                                    {"cropOffsetX", 8},
                                    {"cropOffsetY", 5},
                                    {"cropWidth", 16},
                                    {"cropHeight", 10}}),
                          0, 0, "0.6.0");
    EXPECT_EQ(old.crop, cropped.crop);
    EXPECT_FALSE(film(size + integers({{"crop_width", 40}, {"crop_height", 30}})).crop.is_window());
    // A size from outside is the whole film's: the window keeps its share.
    const Film halved = film(size + window, 20, 15);
    EXPECT_EQ(halved.crop, (CropWindow{4, 2, 20, 15}));
    EXPECT_EQ(halved.width, 8);
    EXPECT_EQ(halved.height, 6) << "rows 2.5 to 7.5: every one that it touches";
    for (const std::string& bad :
         {integers({{"crop_offset_x", 30}, {"crop_width", 11}}), integers({{"crop_offset_x", 40}}),
          integers({{"crop_offset_y", -1}}), integers({{"crop_height", 0}}), integers({{"crop_offset_x", 1}})})
        EXPECT_THROW(film(size + bad), InputError) << bad;
    // The field of view is the whole film's.
    const auto width_seen = [&](const std::string& inside) {
        return load(
                   "<sensor type=\"perspective\"><float name=\"fov\" value=\"50\"/><string name=\"fov_axis\" "
                   "value=\"y\"/><film type=\"hdrfilm\">" +
                       inside + "</film></sensor>",
                   "3.0.0")
            .scene.camera.across.length();
    };
    EXPECT_EQ(width_seen(size + window), width_seen(size));
}

TEST_F(Films, FiltersWithNegativeLobes) {
    const Film mitchell = film("<rfilter type=\"mitchell\"/>");
    EXPECT_EQ(mitchell.filter, PixelFilter::cubic);
    EXPECT_FLOAT_EQ(mitchell.filter_b, 1.0f / 3);
    EXPECT_FLOAT_EQ(mitchell.filter_c, 1.0f / 3);
    EXPECT_TRUE(mitchell.is_signed());
    const Film other = film(
        "<rfilter type=\"mitchell\"><float name=\"B\" value=\"0.5\"/><float name=\"C\" value=\"0.25\"/></rfilter>");
    EXPECT_EQ(other.filter_b, 0.5f);
    EXPECT_EQ(other.filter_c, 0.25f);
    const Film named_a = film(
        "<rfilter type=\"mitchell\"><float name=\"A\" value=\"0.5\"/><float name=\"B\" value=\"0.25\"/></rfilter>");
    EXPECT_EQ(named_a.filter_b, 0.5f);
    EXPECT_EQ(named_a.filter_c, 0.25f);
    const Film catmullrom = film("<rfilter type=\"catmullrom\"/>");
    EXPECT_EQ(catmullrom.filter_b, 0.0f);
    EXPECT_EQ(catmullrom.filter_c, 0.5f);
    EXPECT_EQ(film("<rfilter type=\"lanczos\"/>").filter_radius, 3.0f);
    EXPECT_EQ(film("<rfilter type=\"lanczos\"><integer name=\"lobes\" value=\"2\"/></rfilter>").filter_radius, 2.0f);
    EXPECT_THROW(film("<rfilter type=\"lanczos\"><integer name=\"lobes\" value=\"0\"/></rfilter>"), InputError);
    EXPECT_FALSE(film("<rfilter type=\"gaussian\"/>").is_signed());
}

TEST_F(MitsubaSensors, IntegratorsThatTracePaths) {
    const auto job = [&](const std::string& integrator) {
        Job result;
        apply_layer(result, load_with_sensor(integrator).settings);
        return result;
    };
    EXPECT_EQ(
        job("<integrator type=\"volpath\"><integer name=\"maxDepth\" value=\"9\"/></integrator>").integrator.max_depth,
        9);
    EXPECT_EQ(job("<integrator type=\"direct\"><integer name=\"emitterSamples\" value=\"4\"/></integrator>")
                  .integrator.emitter_samples,
              4);
    EXPECT_EQ(job("<integrator type=\"direct\"/>").guiding.type, Job().guiding.type);
    EXPECT_THROW(job("<integrator type=\"field\"/>"), InputError);
}

TEST_F(MitsubaSensors, WithoutOneTheWholeSceneIsSeen) {
    const std::string scene =
        "<emitter type=\"constant\"/><shape type=\"cube\"><transform name=\"toWorld\"><scale z=\"3\"/>"
        "<translate x=\"5\"/></transform></shape>";
    const LoadedScene old = load(scene);
    const Camera camera = old.scene.camera;
    const float distance = 1.0f / std::tan(static_cast<float>(M_PI) / 8.0f);
    expect_near(camera.origin, Vec3(5, 0, -3 - distance), 1e-4f);
    expect_near(direction(camera, 0.5f, 0.5f), Vec3(0, 0, 1));
    EXPECT_NEAR(camera.across.length(), 2.0f / distance, 1e-4f) << "45 degrees";
    ASSERT_EQ(old.warnings.size(), 1u);
    EXPECT_NE(old.warnings[0].what.find("no sensor"), std::string::npos);
    std::string newer = scene;
    newer.replace(newer.find("toWorld"), 7, "to_world");
    expect_near(load(newer, "2.1.0").scene.camera.origin, Vec3(5, 0, -3 - 3 * distance), 1e-4f);
    EXPECT_NE(refusal_of([&] { load(newer, "3.0.0"); }).find("the scene has no sensor"), std::string::npos);
    expect_near(load(newer, "3.0.0", {}, true).scene.camera.origin, Vec3(5, 0, -3 - 3 * distance), 1e-4f);
}

TEST_F(MitsubaSensors, HiddenEmittersArePassedFromVersion2On) {
    for (const auto& [version, passes] :
         {std::pair("0.6.0", false), std::pair("2.1.0", true), std::pair("3.0.0", true)})
        EXPECT_EQ(load_with_sensor("<emitter type=\"constant\"/>", version).scene.camera.passes_hidden_emitters,
                  passes);
}

}  // namespace
}  // namespace treefarm
