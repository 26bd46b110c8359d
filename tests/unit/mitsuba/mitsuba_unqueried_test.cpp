// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

/// Properties that nobody asks for, repeated ones, and objects that nothing refers to.
class MitsubaUnqueried : public MitsubaFixture {
  protected:
    /// Warnings about what stands in the file, not about the whole scene.
    std::vector<std::string> warnings(const std::string& body) const {
        std::vector<std::string> texts;
        for (const Warning& warning : load_with_sensor(body + "<emitter type=\"point\"/>").warnings)
            if (warning.where.line > 0) texts.push_back(warning.text());
        return texts;
    }
};

const std::string kAlpha =
    "<shape type=\"sphere\"><bsdf type=\"dielectric\"><float name=\"alpha\" value=\"0\"/></bsdf></shape>";

TEST_F(MitsubaUnqueried, OldFilesWarn) {
    ASSERT_EQ(warnings(kAlpha).size(), 1u);
    EXPECT_NE(warnings(kAlpha)[0].find("unknown property \"alpha\""), std::string::npos) << warnings(kAlpha)[0];
    const std::string typing_error = "<integrator type=\"path\"><integer name=\"maxDepht\" value=\"3\"/></integrator>";
    ASSERT_EQ(warnings(typing_error).size(), 1u);
    EXPECT_NE(warnings(typing_error)[0].find("did you mean \"maxDepth\"?"), std::string::npos);
}

TEST_F(MitsubaUnqueried, NewFilesAreStrict) {
    for (const char* version : {"2.0.0", "3.0.0"})
        EXPECT_NE(refusal(kAlpha, version).find("unknown property \"alpha\""), std::string::npos) << version;
}

TEST_F(MitsubaUnqueried, TheLastOfRepeatedPropertiesHolds) {
    const std::string twice =
        "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/><float name=\"radius\" value=\"3\"/></shape>";
    EXPECT_EQ(std::get<Sphere>(load_with_sensor(twice).scene.shapes.at(0).geometry).radius, 3.0f);
    ASSERT_EQ(warnings(twice).size(), 1u);
    EXPECT_NE(warnings(twice)[0].find("given twice"), std::string::npos);
    EXPECT_NE(refusal(twice, "3.0.0").find("given twice"), std::string::npos);
    EXPECT_EQ(refusal(twice, "2.1.0").find("given twice"), std::string::npos) << "Mitsuba 2 warns";

    const std::string bsdfs =
        "<shape type=\"sphere\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.1\"/></bsdf>"
        "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.7\"/></bsdf></shape>";
    const Scene scene = load_with_sensor(bsdfs).scene;
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(std::get<DiffuseMaterial>(scene.materials[0].bsdf).reflectance, Rgb(0.7f));
    EXPECT_NE(refusal(bsdfs, "3.0.0").find("second <bsdf>"), std::string::npos);
}

TEST_F(MitsubaUnqueried, WhatNothingRefersToIsNoObstacle) {
    const std::string unused =
        "<bsdf type=\"measured\" id=\"a\"/>"
        "<bsdf type=\"twosided\" id=\"b\"><ref id=\"a\"/></bsdf>"
        "<texture type=\"mystery\" id=\"c\"/>"
        "<medium type=\"homogeneous\" id=\"d\"/>"
        "<shape type=\"shapegroup\" id=\"e\"><shape type=\"hair\"/></shape>"
        "<shape type=\"sphere\"><ref id=\"f\"/></shape><bsdf type=\"diffuse\" id=\"f\"/>";
    for (const char* version : {"0.6.0", "3.0.0"}) {
        EXPECT_EQ(refusal(unused, version), "") << version;
        EXPECT_NE(refusal(unused + "<shape type=\"sphere\"><ref id=\"b\"/></shape>", version).find("measured"),
                  std::string::npos)
            << "used through another";
    }
    EXPECT_TRUE(warnings(unused).empty());
    const auto checked = load_scene_to_check(folder_ / "scene.xml");
    EXPECT_EQ(std::count_if(checked.findings.begin(), checked.findings.end(),
                            [](const Finding& f) {
                                return f.severity == Finding::Severity::note &&
                                       f.what.find("nothing refers to this") != std::string::npos;
                            }),
              3)
        << "two BSDFs and a group";
}

}  // namespace
}  // namespace treefarm
