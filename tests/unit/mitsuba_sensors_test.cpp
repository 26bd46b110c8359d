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
    EXPECT_THROW(load("<sensor type=\"orthographic\"/>"), InputError);
    const std::string film = "<integer name=\"width\" value=\"30\"/><integer name=\"height\" value=\"20\"/>";
    const auto ldr = load("<sensor type=\"perspective\"><film type=\"ldrfilm\">" + film +
                          "<float name=\"gamma\" value=\"2.2\"/></film></sensor>");
    EXPECT_EQ(ldr.scene.film.width, 30);
    EXPECT_EQ(ldr.warnings.at(0).text().find("ldrfilm") != std::string::npos, true);
    EXPECT_THROW(load("<sensor type=\"perspective\"><film type=\"mfilm\">" + film + "</film></sensor>"), InputError);
    EXPECT_THROW(load("<sensor type=\"perspective\"><film type=\"hdrfilm\">" + film +
                      "<integer name=\"cropWidth\" value=\"10\"/></film></sensor>"),
                 InputError);
    const auto open = load("<sensor type=\"perspective\"><float name=\"shutterClose\" value=\"1\"/></sensor>");
    EXPECT_NE(open.warnings.at(0).text().find("motion"), std::string::npos);
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
                  .integrator.max_depth,
              2);
    EXPECT_EQ(job("<integrator type=\"direct\"/>").guiding.type, Job().guiding.type);
    EXPECT_THROW(job("<integrator type=\"ao\"/>"), InputError);
}

}  // namespace
}  // namespace treefarm
