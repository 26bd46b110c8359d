// SPDX-License-Identifier: Apache-2.0
// Objects of Mitsuba 2 and 3 that stand for spectra: <spectrum type="...">.
#include "coordinator/input/mitsuba/colors.h"
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

class MitsubaSpectra : public MitsubaFixture {
  protected:
    static std::string object(const std::string& type, const std::string& inside, const std::string& name,
                              const std::string& tag = "spectrum") {
        return "<" + tag + " type=\"" + type + "\" name=\"" + name + "\">" + inside + "</" + tag + ">";
    }
    ColorInput reflectance(const std::string& property, const std::string& version = "3.0.0") const {
        const Scene scene =
            load_with_sensor("<shape type=\"rectangle\"><bsdf type=\"diffuse\">" + property + "</bsdf></shape>",
                             version)
                .scene;
        return std::get<DiffuseMaterial>(scene.materials.at(0).bsdf).reflectance;
    }
    Rgb intensity(const std::string& property) const {
        const Scene scene = load_with_sensor("<emitter type=\"point\">" + property + "</emitter>", "3.0.0").scene;
        return std::get<PointEmitter>(scene.emitters.at(0).kind).intensity;
    }
};

const std::string kHalf = "<float name=\"value\" value=\"0.5\"/>";

TEST_F(MitsubaSpectra, ConstantsAreThemselves) {
    EXPECT_EQ(reflectance(object("uniform", kHalf, "reflectance")), ColorInput(Rgb(0.5f)));
    EXPECT_EQ(reflectance(object("uniform", kHalf, "reflectance", "texture")), ColorInput(Rgb(0.5f)));
    EXPECT_EQ(reflectance(object("rawconstant", kHalf, "reflectance")), ColorInput(Rgb(0.5f)));
    EXPECT_EQ(reflectance(object("rawconstant", "<vector name=\"value\" value=\"0.1 0.2 0.3\"/>", "reflectance")),
              ColorInput(Rgb(0.1f, 0.2f, 0.3f)));
    EXPECT_EQ(reflectance(object("srgb", "<rgb name=\"color\" value=\"0.1 0.2 0.3\"/>", "reflectance")),
              ColorInput(Rgb(0.1f, 0.2f, 0.3f)));
    EXPECT_EQ(intensity(object("uniform", kHalf, "intensity")), Rgb(0.5f)) << "unlike <spectrum value=\"0.5\"/>";
}

TEST_F(MitsubaSpectra, D65IsWhite) {
    EXPECT_EQ(intensity(object("d65", "", "intensity")), Rgb(1.0f));
    EXPECT_EQ(intensity(object("d65", "<float name=\"scale\" value=\"3\"/>", "intensity")), Rgb(3.0f));
    EXPECT_EQ(intensity(object("d65", "<float name=\"scale\" value=\"3\"/><rgb name=\"color\" value=\"1 2 4\"/>",
                               "intensity")),
              Rgb(3, 6, 12));
    const ColorInput lit = reflectance(object(
        "d65", "<float name=\"scale\" value=\"0.5\"/>" + object("checkerboard", "", "", "texture"), "reflectance"));
    EXPECT_TRUE(lit.varies());
    EXPECT_EQ(lit.value, Rgb(0.5f));
}

TEST_F(MitsubaSpectra, TablesAreLists) {
    const std::string wavelengths = "<string name=\"wavelengths\" value=\"400, 500, 700\"/>";
    const std::string values = "<string name=\"values\" value=\"0.1, 0.8, 0.3\"/>";
    EXPECT_EQ(reflectance(object("irregular", wavelengths + values, "reflectance")),
              reflectance("<spectrum name=\"reflectance\" value=\"400:0.1, 500:0.8, 700:0.3\"/>"));
    EXPECT_EQ(intensity(object("irregular", wavelengths + values, "intensity")),
              intensity("<spectrum name=\"intensity\" value=\"400:0.1, 500:0.8, 700:0.3\"/>"));
    const std::string range =
        "<float name=\"wavelength_min\" value=\"400\"/><float name=\"wavelength_max\" value=\"700\"/>";
    EXPECT_EQ(reflectance(object("regular", range + values, "reflectance")),
              reflectance("<spectrum name=\"reflectance\" value=\"400:0.1, 550:0.8, 700:0.3\"/>"));
    expect_near(intensity(object("blackbody", "<float name=\"temperature\" value=\"5000\"/>", "intensity")),
                Vec3(Imath::V3d(mitsuba::blackbody_color(5000.0, {}))), 1e-3f);
}

TEST_F(MitsubaSpectra, BadOnesAreRefused) {
    for (const std::string& bad :
         {object("uniform", "", "reflectance"), object("uniform", "<float name=\"value\" value=\"2\"/>", "reflectance"),
          object("uniform", kHalf + kHalf, "reflectance"),
          object("uniform", kHalf + "<float name=\"x\" value=\"1\"/>", "reflectance"),
          object("irregular", "<string name=\"wavelengths\" value=\"400\"/><string name=\"values\" value=\"1\"/>",
                 "reflectance"),
          object("irregular",
                 "<string name=\"wavelengths\" value=\"500, 400\"/><string name=\"values\" value=\"1, 1\"/>",
                 "reflectance"),
          object("regular", "<string name=\"values\" value=\"0.1, 0.2\"/>", "reflectance"),
          object("blackbody", "<float name=\"temperature\" value=\"5000\"/>", "reflectance"),
          object("d64", "", "reflectance")})
        EXPECT_THROW(reflectance(bad), InputError) << bad;
    EXPECT_THROW(reflectance(object("uniform", kHalf, "reflectance"), "0.6.0"), InputError);
    EXPECT_THROW(intensity(object("checkerboard", "", "intensity", "texture")), InputError);
}

TEST_F(MitsubaSpectra, MatricesOfNineNumbersAreTheLinearPart) {
    const auto corner = [&](const std::string& matrix) {
        return mesh_of(load_with_sensor("<shape type=\"rectangle\"><transform name=\"to_world\">" + matrix +
                                            "<translate x=\"10\"/></transform></shape>",
                                        "3.0.0"))
            .positions.at(1);
    };
    expect_near(corner("<matrix value=\"1 2 3 4 5 6 7 8 10\"/>"),
                corner("<matrix value=\"1 2 3 0 4 5 6 0 7 8 10 0 0 0 0 1\"/>"));
    EXPECT_THROW(corner("<matrix value=\"1 2 3 4 5 6 7 8\"/>"), InputError);
}

}  // namespace
}  // namespace treefarm
