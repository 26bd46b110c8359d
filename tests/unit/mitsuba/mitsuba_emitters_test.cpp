// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "common/image/exr.h"
#include "coordinator/input/mitsuba/colors.h"
#include "tests/support/mitsuba_fixture.h"
#include "tests/support/refusal.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

class MitsubaEmitters : public MitsubaFixture {
  protected:
    LoadedScene emitter(const std::string& type, const std::string& inside,
                        const std::string& version = "0.6.0") const {
        return load_with_sensor("<emitter type=\"" + type + "\">" + inside + "</emitter>", version);
    }
    template <class T>
    T only(const std::string& type, const std::string& inside, const std::string& version = "0.6.0") const {
        return std::get<T>(emitter(type, inside, version).scene.emitters.at(0).kind);
    }
};

const std::string kMoved =
    "<transform name=\"toWorld\"><rotate y=\"1\" angle=\"90\"/><translate x=\"1\" y=\"2\" z=\"3\"/></transform>";

TEST_F(MitsubaEmitters, Points) {
    const auto at = only<PointEmitter>("point",
                                       "<point name=\"position\" x=\"1\" y=\"2\" z=\"3\"/>"
                                       "<rgb name=\"intensity\" value=\"4 5 6\"/>");
    EXPECT_EQ(at.position, Vec3(1, 2, 3));
    EXPECT_EQ(at.intensity, Rgb(4, 5, 6));
    EXPECT_EQ(only<PointEmitter>("point", kMoved).position, Vec3(1, 2, 3));
    EXPECT_EQ(only<PointEmitter>("point", kMoved).intensity, Rgb(1.0f));
    EXPECT_THROW(emitter("point", kMoved + "<point name=\"position\" x=\"1\" y=\"2\" z=\"3\"/>"), InputError);
    EXPECT_THROW(emitter("point", "<rgb name=\"intensity\" value=\"-1\"/>"), InputError);
}

TEST_F(MitsubaEmitters, Spots) {
    const auto spot = only<SpotEmitter>("spot", kMoved);
    EXPECT_EQ(spot.position, Vec3(1, 2, 3));
    expect_near(spot.axis, Vec3(1, 0, 0));
    EXPECT_NEAR(spot.cutoff, 20 * kPi / 180, 1e-6f);
    EXPECT_NEAR(spot.beam, 15 * kPi / 180, 1e-6f);
    const auto narrow = only<SpotEmitter>(
        "spot", "<float name=\"cutoff_angle\" value=\"8\"/><float name=\"beam_width\" value=\"0\"/>", "3.0.0");
    EXPECT_NEAR(narrow.cutoff, 8 * kPi / 180, 1e-6f);
    EXPECT_EQ(narrow.beam, 0.0f);
    EXPECT_THROW(emitter("spot", "<float name=\"cutoffAngle\" value=\"0\"/>"), InputError);
    EXPECT_THROW(emitter("spot", "<float name=\"beamWidth\" value=\"21\"/>"), InputError);
}

TEST_F(MitsubaEmitters, SpotsProjectTextures) {
    const std::string board =
        "<texture type=\"checkerboard\" name=\"texture\"><rgb name=\"color0\" value=\"5\"/>"
        "<rgb name=\"color1\" value=\"0\"/></texture>";
    for (const char* version : {"0.6.0", "3.0.0"}) {
        const Scene scene = emitter("spot", kMoved + board + "<rgb name=\"intensity\" value=\"2\"/>", version).scene;
        const auto& spot = std::get<SpotEmitter>(scene.emitters.at(0).kind);
        EXPECT_EQ(spot.texture, 0);
        EXPECT_EQ(scene.textures.size(), 1u);
        EXPECT_EQ(spot.intensity, Rgb(2.0f));
        // Turned by 90 degrees about y: x goes to -z, z to x.
        expect_near(spot.axis, Vec3(1, 0, 0));
        expect_near(spot.x_axis, Vec3(0, 0, -1));
        expect_near(spot.y_axis, Vec3(0, 1, 0));
    }
    const std::string constant = "<spectrum name=\"texture\" value=\"0.25\"/>";
    EXPECT_EQ(only<SpotEmitter>("spot", constant).intensity, Rgb(1.0f)) << "of no influence in Mitsuba 0.6";
    EXPECT_EQ(only<SpotEmitter>("spot", constant).texture, kNone);
    EXPECT_THROW(emitter("spot", board + "<float name=\"cutoffAngle\" value=\"90\"/>"), InputError);
    EXPECT_THROW(emitter("spot", board + "<transform name=\"toWorld\"><scale x=\"2\"/></transform>"), InputError);
}

TEST_F(MitsubaEmitters, Projectors) {
    const std::string turned =
        "<transform name=\"to_world\"><rotate y=\"1\" angle=\"90\"/><translate x=\"1\" y=\"2\" z=\"3\"/></transform>";
    for (const char* version : {"2.0.0", "3.0.0"}) {
        const auto plain =
            only<ProjectorEmitter>("projector",
                                   turned +
                                       "<rgb name=\"irradiance\" value=\"2 4 6\"/><float name=\"scale\" value=\"0.5\"/>"
                                       "<float name=\"fov\" value=\"90\"/>",
                                   version);
        EXPECT_EQ(plain.position, Vec3(1, 2, 3));
        // Turned by 90 degrees about y: x goes to -z, z to x. Pictures rise to the right, which is -x, and down.
        expect_near(plain.axis, Vec3(1, 0, 0));
        expect_near(plain.x_axis, Vec3(0, 0, 1));
        expect_near(plain.y_axis, Vec3(0, -1, 0));
        expect_near(Vec3(plain.irradiance.value), Vec3(1, 2, 3) * kPi);
        EXPECT_FALSE(plain.irradiance.varies());
        EXPECT_NEAR(plain.half_width, 1.0f, 1e-6f);
        EXPECT_NEAR(plain.half_height, 1.0f, 1e-6f) << "a constant is one texel";
    }
    // 50 mm if nothing is said: half the diagonal of 36 x 24 mm, on a square.
    const auto usual = only<ProjectorEmitter>("projector", "", "3.0.0");
    EXPECT_NEAR(usual.half_width, std::sqrt(36.0 * 36 + 24 * 24) / 100 / std::sqrt(2.0), 1e-6);
    expect_near(Vec3(usual.irradiance.value), Vec3(kPi));
    EXPECT_EQ(only<ProjectorEmitter>("projector", "<string name=\"focal_length\" value=\"50mm\"/>", "3.0.0").half_width,
              usual.half_width);

    Image image{4, 2, {}, {}};
    image.add_channel("Y");
    write_exr(folder_ / "slide.exr", image);
    const std::string slide =
        "<texture name=\"irradiance\" type=\"bitmap\"><string name=\"filename\" value=\"slide.exr\"/></texture>";
    const Scene scene = emitter("projector", slide + "<float name=\"fov\" value=\"90\"/>", "3.0.0").scene;
    const auto& shown = std::get<ProjectorEmitter>(scene.emitters.at(0).kind);
    EXPECT_EQ(shown.irradiance.texture, 0);
    EXPECT_EQ(scene.images.at(0).width, 4) << "in use";
    EXPECT_NEAR(shown.half_width, 1.0f, 1e-6f);
    EXPECT_NEAR(shown.half_height, 0.5f, 1e-6f);
    const std::string by_height = "<float name=\"fov\" value=\"90\"/><string name=\"fov_axis\" value=\"y\"/>";
    EXPECT_NEAR(only<ProjectorEmitter>("projector", slide + by_height, "3.0.0").half_width, 2.0f, 1e-5f);

    const auto refusal = [&](const std::string& inside, const char* version = "3.0.0") {
        return test::refusal_of([&] { emitter("projector", inside, version); });
    };
    for (const auto& [inside, word] : std::map<std::string, std::string>{
             {"<float name=\"fov\" value=\"180\"/>", "field of view"},
             {"<float name=\"fov\" value=\"9\"/><string name=\"focal_length\" value=\"9mm\"/>", "keep one"},
             {"<float name=\"fov\" value=\"9\"/><string name=\"fov_axis\" value=\"z\"/>", "unknown axis"},
             {"<float name=\"scale\" value=\"-1\"/>", "give 0 or more"},
             {"<rgb name=\"irradiance\" value=\"-1\"/>", "a radiance of -1"},
             {"<transform name=\"to_world\"><scale value=\"2\"/></transform>", "scale or shear"},
             {"<float name=\"cutoff_angle\" value=\"9\"/>", "cutoff_angle"}})
        EXPECT_NE(refusal(inside).find(word), std::string::npos) << inside << ": " << refusal(inside);
    const std::string old = refusal("", "0.6.0");
    EXPECT_NE(old.find("<emitter type=\"projector\"> is not available"), std::string::npos) << old;
    EXPECT_EQ(old.find("projector,"), std::string::npos) << "no cure of a file of 0.6: " << old;
}

TEST_F(MitsubaEmitters, DirectionsThatLightTravels) {
    const auto sun = only<DirectionalEmitter>("directional",
                                              "<vector name=\"direction\" x=\"0\" y=\"-2\" z=\"0\"/>"
                                              "<spectrum name=\"irradiance\" value=\"3\"/>");
    expect_near(sun.direction, Vec3(0, -1, 0));
    EXPECT_EQ(sun.irradiance, Rgb(3.0f));
    expect_near(only<DirectionalEmitter>("directional", kMoved).direction, Vec3(1, 0, 0));
    EXPECT_THROW(emitter("directional", "<vector name=\"direction\" x=\"0\" y=\"0\" z=\"0\"/>"), InputError);
}

TEST_F(MitsubaEmitters, ImagesOfTheEnvironment) {
    Image image{2, 1, {}, {}};
    const auto values = image.add_channel("Y");
    values[0] = 3.0f;
    write_exr(folder_ / "sky.exr", image);
    const std::string file = "<string name=\"filename\" value=\"sky.exr\"/>";
    const auto loaded = emitter("envmap", file +
                                              "<float name=\"scale\" value=\"2\"/><transform name=\"toWorld\">"
                                              "<rotate y=\"1\" angle=\"90\"/></transform>");
    const auto& environment = std::get<EnvironmentEmitter>(loaded.scene.emitters.at(0).kind);
    EXPECT_EQ(environment.scale, 2.0f);
    expect_near(environment.x_axis, Vec3(0, 0, -1));
    expect_near(environment.y_axis, Vec3(0, 1, 0));
    expect_near(environment.z_axis, Vec3(1, 0, 0));
    EXPECT_EQ(loaded.scene.images.at(0).floats, (std::vector<float>{3, 3, 3, 0, 0, 0})) << "three channels of floats";
    EXPECT_THROW(emitter("envmap", ""), InputError);
    EXPECT_THROW(emitter("envmap", file + "<float name=\"scale\" value=\"-2\"/>"), InputError);
    EXPECT_THROW(emitter("envmap", file + "<transform name=\"toWorld\"><scale value=\"2\"/></transform>"), InputError);
    EXPECT_THROW(load_with_sensor("<emitter type=\"constant\"/><emitter type=\"envmap\">" + file + "</emitter>"),
                 InputError);
}

TEST_F(MitsubaEmitters, TexturedAreaLights) {
    const auto loaded = load_with_sensor(
        "<shape type=\"rectangle\"><emitter type=\"area\"><texture name=\"radiance\" type=\"checkerboard\">"
        "<rgb name=\"color0\" value=\"7\"/></texture></emitter></shape>");
    const auto& area = std::get<AreaEmitter>(loaded.scene.emitters.at(0).kind);
    EXPECT_EQ(area.radiance.texture, 0);
    EXPECT_EQ(std::get<CheckerboardTexture>(loaded.scene.textures.at(0).kind).color0, Rgb(7.0f));
}

TEST_F(MitsubaEmitters, SpectraFromFilesAndBlackBodies) {
    write("s.spd", "# a comment\n400 1\n700 9\n");
    const auto intensity = [&](const std::string& value) { return only<PointEmitter>("point", value).intensity; };
    EXPECT_EQ(intensity("<spectrum name=\"intensity\" filename=\"s.spd\"/>"),
              intensity("<spectrum name=\"intensity\" value=\"400:1, 700:9\"/>"));
    for (const char* text : {"400 1", "400 1\n300 2", "400 1\n500", "400 1\n500 x"}) {
        write("bad.spd", text);
        EXPECT_THROW(intensity("<spectrum name=\"intensity\" filename=\"bad.spd\"/>"), InputError) << text;
    }
    EXPECT_THROW(intensity("<spectrum name=\"intensity\" filename=\"none.spd\"/>"), InputError);

    // The Planckian locus: x, y of 2856 K is illuminant A's (0.44757, 0.40745).
    const auto rgb = mitsuba::blackbody_color(2856.0, {});
    const double x = 0.412453 * rgb.x + 0.357580 * rgb.y + 0.180423 * rgb.z;
    const double y = 0.212671 * rgb.x + 0.715160 * rgb.y + 0.072169 * rgb.z;
    const double z = 0.019334 * rgb.x + 0.119193 * rgb.y + 0.950227 * rgb.z;
    EXPECT_NEAR(x / (x + y + z), 0.44757, 3e-4);
    EXPECT_NEAR(y / (x + y + z), 0.40745, 3e-4);
    const Rgb half = intensity("<blackbody name=\"intensity\" temperature=\"5000K\" scale=\"0.5\"/>");
    expect_near(half * 2.0f, intensity("<blackbody name=\"intensity\" temperature=\"5000\"/>"), 1e-3f * half.x);
    EXPECT_THROW(intensity("<blackbody name=\"intensity\" temperature=\"-1\"/>"), InputError);
}

/// The sun of a picture that was written as half floats.
TEST_F(MitsubaEmitters, InfiniteLightStaysTheBrightest) {
    Image image{2, 1, {}, {}};
    RgbImage rgb(2, 1, Rgb(0.5f));
    rgb.pixels[1] = Rgb(std::numeric_limits<float>::infinity());
    add_rgb_layer(image, "", rgb);
    write_exr(folder_ / "sun.exr", image);
    const auto loaded =
        load_with_sensor("<emitter type=\"envmap\"><string name=\"filename\" value=\"sun.exr\"/></emitter>", "3.0.0");
    EXPECT_EQ(loaded.scene.images.at(0).floats, (std::vector<float>{0.5f, 0.5f, 0.5f, 65504.0f, 65504.0f, 65504.0f}));
    EXPECT_TRUE(std::any_of(loaded.warnings.begin(), loaded.warnings.end(),
                            [](const Warning& w) { return w.text().find("65504") != std::string::npos; }));
}

/// A beam is a spot of its power, a milliradian wide.
TEST_F(MitsubaEmitters, CollimatedBeams) {
    const std::string beam =
        "<emitter type=\"collimated\"><transform name=\"toWorld\"><lookat origin=\"1,2,3\" target=\"1,2,9\" "
        "up=\"0,1,0\"/>"
        "</transform><spectrum name=\"power\" value=\"2\"/></emitter>";
    const Scene scene = load_with_sensor(beam).scene;
    const auto& spot = std::get<SpotEmitter>(scene.emitters.at(0).kind);
    EXPECT_EQ(spot.position, Vec3(1, 2, 3));
    EXPECT_NEAR(spot.axis.z, 1.0f, 1e-6f);
    EXPECT_EQ(spot.beam, spot.cutoff);
    EXPECT_NEAR(spot.intensity.x * static_cast<float>(M_PI) * spot.cutoff * spot.cutoff, 2.0f, 1e-4f);
    EXPECT_NE(refusal(beam, "3.0.0"), "") << "Mitsuba 3 has none";
}

/// Mitsuba 0.6 adds sun and sky to a scene without an emitter.
TEST_F(MitsubaEmitters, WithoutOneThereAreSunAndSky) {
    const std::string sphere = "<shape type=\"sphere\"/>";
    const LoadedScene lit = load_with_sensor(sphere);
    EXPECT_NE(lit.scene.environment(), kNone);
    ASSERT_EQ(lit.warnings.size(), 1u);
    EXPECT_NE(lit.warnings[0].what.find("sun and sky are added"), std::string::npos);
    EXPECT_EQ(load_with_sensor(sphere + "<emitter type=\"point\"/>").scene.emitters.size(), 1u);
    EXPECT_TRUE(load_with_sensor(sphere, "3.0.0").scene.emitters.empty());
}

}  // namespace
}  // namespace treefarm
