// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mitsuba_fixture.h"
#include "tests/support/refusal.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

class MitsubaInstances : public MitsubaFixture {
  protected:
    std::string message_of(const std::string& body) const {
        return test::refusal_of([&] { load_with_sensor(body); }, "no error");
    }

    void expect_refused(const std::string& body, const std::string& about) const {
        EXPECT_NE(message_of(body).find(about), std::string::npos) << message_of(body);
    }
};

const std::string kGroup =
    "<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\"><bsdf type=\"diffuse\"/></shape>"
    "<shape type=\"cube\"/></shape>\n";

TEST_F(MitsubaInstances, GroupsArePlacedByInstances) {
    for (const auto& [name, version] : {std::pair("toWorld", "0.6.0"), std::pair("to_world", "3.0.0")}) {
        const auto loaded =
            load_with_sensor(kGroup + "<shape type=\"instance\" id=\"i\"><ref id=\"g\"/><transform name=\"" + name +
                                 "\"><scale x=\"2\"/><translate y=\"10\"/></transform></shape><shape "
                                 "type=\"instance\"><ref id=\"g\"/></shape>",
                             version);
        const Scene& scene = loaded.scene;
        ASSERT_EQ(scene.shapes.size(), 4u);
        EXPECT_EQ(scene.group_count, 1);
        EXPECT_EQ(scene.shapes[0].group, 0);
        EXPECT_EQ(scene.shapes[1].group, 0);
        EXPECT_EQ(scene.shapes[2].group, kNone);
        EXPECT_EQ(scene.shapes[2].material, kNone);
        EXPECT_EQ(scene.shapes[2].name, "i");
        const auto& instance = std::get<Instance>(scene.shapes[2].geometry);
        EXPECT_EQ(instance.group, 0);
        expect_near(Vec3(1, 1, 1) * instance.to_world, Vec3(2, 11, 1));
        EXPECT_EQ(std::get<Instance>(scene.shapes[3].geometry).to_world, Imath::M44f());
        expect_near(scene.bounds().min, Vec3(-2, -1, -1));
        expect_near(scene.bounds().max, Vec3(2, 11, 1));
        EXPECT_EQ(scene.triangle_count(), 12u);
    }
}

TEST_F(MitsubaInstances, OrderDoesNotMatter) {
    const auto loaded = load_with_sensor("<shape type=\"instance\"><ref id=\"g\"/></shape>\n" + kGroup +
                                         "<shape type=\"shapegroup\" id=\"h\"><shape type=\"cube\"/></shape>"
                                         "<shape type=\"instance\"><ref id=\"h\"/></shape>");
    EXPECT_EQ(loaded.scene.group_count, 2);
    ASSERT_EQ(loaded.scene.shapes.size(), 5u);
    EXPECT_EQ(std::get<Instance>(loaded.scene.shapes[2].geometry).group, 0);
    EXPECT_EQ(std::get<Instance>(loaded.scene.shapes[4].geometry).group, 1);
}

TEST_F(MitsubaInstances, WhatCannotBePlaced) {
    expect_refused("<shape type=\"instance\"/>", "places no shapegroup");
    expect_refused("<shape type=\"cube\" id=\"c\"/><shape type=\"instance\"><ref id=\"c\"/></shape>",
                   "places no shapegroup");
    expect_refused("<shape type=\"instance\"><ref id=\"none\"/></shape>", "\"none\"");
    const auto placed = [](const char* id) {
        return "<shape type=\"instance\"><ref id=\"" + std::string(id) + "\"/></shape>";
    };
    expect_refused("<shape type=\"shapegroup\" id=\"e\"/>" + placed("e"), "has no shapes");
    expect_refused(kGroup + "<shape type=\"shapegroup\" id=\"n\">" + placed("g") + "</shape>" + placed("n"),
                   "within a shapegroup");
    expect_refused("<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"><emitter type=\"area\"/></shape></shape>" +
                       placed("g"),
                   "has an emitter");
    expect_refused(kGroup + "<shape type=\"instance\"><ref id=\"g\"/><bsdf type=\"diffuse\"/></shape>", "bsdf");
    expect_refused(kGroup +
                       "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"toWorld\"><scale x=\"0\"/>"
                       "</transform></shape>",
                   "singular");
    expect_refused(kGroup +
                       "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"toWorld\"><scale x=\"1e20\"/>"
                       "</transform></shape>",
                   "1e18");
}

TEST_F(MitsubaInstances, LenientReadingSkipsThem) {
    const auto loaded = load(
        "<sensor type=\"perspective\"/><shape type=\"shapegroup\" id=\"e\"><shape type=\"torus\"/></shape>"
        "<shape type=\"instance\"><ref id=\"e\"/></shape>"
        "<shape type=\"shapegroup\" id=\"l\"><shape type=\"cube\"><emitter type=\"area\"/></shape></shape>"
        "<shape type=\"instance\"><ref id=\"l\"/></shape>",
        "0.6.0", {}, true);
    EXPECT_EQ(loaded.scene.group_count, 1);
    EXPECT_EQ(loaded.scene.shapes.size(), 2u);
    EXPECT_TRUE(loaded.scene.emitters.empty());
    EXPECT_GE(loaded.warnings.size(), 4u);
}

}  // namespace
}  // namespace treefarm
