#include <algorithm>
#include <limits>

#include "common/image/exr.h"
#include "common/scene/mitsuba/blackbody.h"
#include "common/scene/mitsuba/daylight.h"
#include "tests/support/mitsuba_fixture.h"
#include "tests/support/support.h"

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

TEST_F(MitsubaEmitters, TheSunStandsWhereItShould) {
    // On the equator at an equinox the sun culminates at the zenith; in Tokyo it stands in the south at noon.
    mitsuba::Observation equator;
    equator.year = 2010, equator.month = 3, equator.day = 20;
    equator.latitude = equator.longitude = equator.timezone = 0.0;
    equator.hour = 12.0, equator.minute = 7.5;  // the equation of time is -7.5 minutes
    EXPECT_LT(mitsuba::sun_position(equator).zenith, 0.5 * M_PI / 180);
    mitsuba::Observation tokyo;
    tokyo.hour = 11.0, tokyo.minute = 46.0;
    EXPECT_NEAR(std::abs(mitsuba::sun_position(tokyo).azimuth), M_PI, 2 * M_PI / 180);
    EXPECT_NEAR(mitsuba::sun_position(tokyo).zenith, (35.69 - 22.2) * M_PI / 180, 0.2 * M_PI / 180);
    tokyo.hour = 8.0;
    EXPECT_GT(std::sin(mitsuba::sun_position(tokyo).azimuth), 0.5) << "in the morning it stands in the east";
}

/// Irradiance of an environment on a plane that faces each of its pixels: the sum of radiance times solid angle.
Imath::Color3<double> total(const TextureImage& image) {
    Imath::Color3<double> sum(0.0);
    for (int y = 0; y < image.height; ++y) {
        const double ring = std::cos(y * M_PI / image.height) - std::cos((y + 1) * M_PI / image.height);
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c)
                sum[c] += double(image.floats[static_cast<std::size_t>(3 * (y * image.width + x) + c)]) * ring * 2 *
                          M_PI / image.width;
    }
    return sum;
}

TEST_F(MitsubaEmitters, TheSunsEnergyDoesNotDependOnItsSizeInTheImage) {
    const auto parallel = emitter("sun", "<float name=\"sunRadiusScale\" value=\"0\"/>").scene;
    ASSERT_EQ(parallel.emitters.size(), 1u);
    const auto& direct = std::get<DirectionalEmitter>(parallel.emitters[0].kind);
    EXPECT_LT(direct.direction.y, 0.0f);
    for (const char* inside :
         {"", "<float name=\"sunRadiusScale\" value=\"8\"/>", "<integer name=\"resolution\" value=\"33\"/>"}) {
        const auto scene = emitter("sun", inside).scene;
        const auto sum = total(scene.images.at(0));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c] / double(direct.irradiance[c]), 1.0, 1e-3) << inside;
    }
}

TEST_F(MitsubaEmitters, TheSkyAndItsSettings) {
    const auto brightness = [&](const std::string& type, const std::string& inside, const char* version = "0.6.0") {
        const auto loaded = emitter(type, inside, version);
        EXPECT_NE(loaded.warnings.at(0).text().find("Preetham"), std::string::npos);
        return total(loaded.scene.images.at(0)).y;
    };
    const double sky = brightness("sky", "");
    EXPECT_GT(sky, 0.1);
    EXPECT_NEAR(brightness("sky", "<float name=\"scale\" value=\"3\"/>") / sky, 3.0, 1e-4);
    EXPECT_GT(brightness("sky", "<float name=\"stretch\" value=\"2\"/>"), 1.5 * sky);
    EXPECT_NEAR(brightness("sunsky", "") - sky, brightness("sun", ""), 1e-3 * sky);
    EXPECT_NEAR(brightness("sunsky", "<float name=\"sunScale\" value=\"0\"/>"), sky, 1e-4 * sky);
    EXPECT_NEAR(brightness("sunsky", "<float name=\"sun_scale\" value=\"0\"/>", "3.0.0"), sky, 1e-4 * sky);
    EXPECT_THROW(emitter("sky", "<float name=\"hour\" value=\"23\"/>"), InputError) << "night";
    EXPECT_THROW(emitter("sky", "<float name=\"turbidity\" value=\"11\"/>"), InputError);
    EXPECT_THROW(emitter("sky", "<integer name=\"resolution\" value=\"1000000\"/>"), InputError);
    EXPECT_THROW(
        emitter("sky", "<float name=\"hour\" value=\"9\"/><vector name=\"sunDirection\" x=\"0\" y=\"1\" z=\"0\"/>"),
        InputError);
}

/// Towards the brightest pixel of the scene's environment.
Vec3 brightest_direction(const Scene& scene) {
    const auto& environment = std::get<EnvironmentEmitter>(scene.emitters.at(0).kind);
    const TextureImage& image = scene.images.at(0);
    const auto brightest = std::max_element(image.floats.begin(), image.floats.end()) - image.floats.begin();
    const auto x = static_cast<float>(brightest / 3 % image.width);
    const auto y = static_cast<float>(brightest / 3 / image.width);
    const float phi = (x + 0.5f) * 2 * kPi / static_cast<float>(image.width);
    const float theta = (y + 0.5f) * kPi / static_cast<float>(image.height);
    return environment.x_axis * (std::sin(theta) * std::sin(phi)) + environment.y_axis * std::cos(theta) -
           environment.z_axis * (std::sin(theta) * std::cos(phi));
}

TEST_F(MitsubaEmitters, TheSunIsWhereItsDirectionSays) {
    for (const char* version : {"0.6.0", "3.0.0"}) {
        const auto scene =
            emitter("sunsky",
                    "<vector name=\"sun_direction\" x=\"3\" y=\"2\" z=\"1\"/><transform name=\"to_world\">"
                    "<rotate x=\"1\" angle=\"20\"/></transform>",
                    version)
                .scene;
        EXPECT_LT((brightest_direction(scene) - normalize(Vec3(3, 2, 1))).length(), 0.02f) << version;
    }
}

TEST_F(MitsubaEmitters, TheFrameOfTheSkyDependsOnTheVersion) {
    const auto sun = [&](const char* hour, const char* version) {
        return brightest_direction(
            emitter("sunsky", "<float name=\"hour\" value=\"" + std::string(hour) + "\"/>", version).scene);
    };
    // 0.6: y up, east at x, north at -z. 3: z up, south at x, west at y.
    const Vec3 old_morning = sun("8", "0.6.0"), old_noon = sun("11.77", "0.6.0");
    EXPECT_GT(old_morning.x, 0.6f);
    EXPECT_GT(old_noon.z, 0.2f);
    EXPECT_GT(old_noon.y, 0.9f);
    const Vec3 morning = sun("8", "3.0.0"), noon = sun("11.77", "3.0.0");
    EXPECT_LT(morning.y, -0.6f);
    EXPECT_GT(noon.x, 0.2f);
    EXPECT_GT(noon.z, 0.9f);
}

TEST_F(MitsubaEmitters, TheKitchensSunAgreesWithMitsubas) {
    const std::string model = shared_scene("kitchen/kitchen.xml"), baked = shared_scene("kitchen/textures/sunsky.exr");
    if (model.empty() || baked.empty()) GTEST_SKIP() << "../shared/scenes is not here";
    const auto scene = emitter("sunsky",
                               "<float name=\"hour\" value=\"9\"/><float name=\"turbidity\" value=\"5\"/>"
                               "<float name=\"sunRadiusScale\" value=\"4\"/><float name=\"scale\" value=\"50\"/>")
                           .scene;
    const TextureImage& image = scene.images.at(0);
    const RgbImage reference = read_exr_rgb(baked).image;
    ASSERT_EQ(image.width, reference.width);
    // The sun fills the pixels around (140, 54); the sky is brighter in Preetham's model, by 1.4 to 1.5 on the whole.
    Imath::Color3<double> ours(0.0), theirs(0.0), sky(0.0), their_sky(0.0);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const bool sun = std::abs(x - 140) <= 4 && std::abs(y - 54) <= 4;
            const double weight = std::sin((y + 0.5) * M_PI / image.height);
            const std::size_t at = static_cast<std::size_t>(y * image.width + x);
            for (int c = 0; c < 3; ++c) {
                (sun ? ours : sky)[c] += weight * double(image.floats[3 * at + static_cast<std::size_t>(c)]);
                (sun ? theirs : their_sky)[c] += weight * double(reference.pixels[at][c]);
            }
        }
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(ours[c] / theirs[c], 1.0, 0.01);
        EXPECT_NEAR(sky[c] / their_sky[c], 1.45, 0.1);
    }
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

}  // namespace
}  // namespace treefarm
