#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

using MitsubaMaterials = MitsubaFixture;

TEST_F(MitsubaMaterials, MaterialsAndReferences) {
    const auto loaded = load_with_sensor(
        "<bsdf type=\"twosided\" id=\"both\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.1 0.2 "
        "0.3\"/></bsdf></bsdf>"
        "<bsdf type=\"twosided\" id=\"of ref\"><ref id=\"one\"/></bsdf>"
        "<bsdf type=\"diffuse\" id=\"one\"/><alias id=\"one\" as=\"uno\"/>"
        "<shape type=\"rectangle\"><ref id=\"both\"/></shape>"
        "<shape type=\"rectangle\"><ref name=\"bsdf\" id=\"uno\"/></shape>"
        "<shape type=\"rectangle\"><ref id=\"of ref\"/></shape>"
        "<shape type=\"rectangle\"/>"
        "<shape type=\"rectangle\"><emitter type=\"area\"><spectrum name=\"radiance\" value=\"3\"/></emitter></shape>"
        "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"4\"/></emitter>");
    const Scene& scene = loaded.scene;
    const auto material = [&](std::size_t shape) {
        return scene.materials.at(static_cast<std::size_t>(scene.shapes[shape].material));
    };
    const auto reflectance = [&](std::size_t shape) {
        return std::get<DiffuseMaterial>(material(shape).bsdf).reflectance;
    };
    EXPECT_TRUE(material(0).twosided);
    EXPECT_EQ(material(0).name, "both");
    EXPECT_EQ(reflectance(0), Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_FALSE(material(1).twosided);
    EXPECT_EQ(material(1).name, "one");
    EXPECT_TRUE(material(2).twosided);
    EXPECT_EQ(reflectance(2), Rgb(0.5f));
    EXPECT_EQ(reflectance(3), Rgb(0.5f));
    EXPECT_EQ(reflectance(4), Rgb(0.0f)) << "an emitter without a BSDF is black";
    EXPECT_EQ(scene.shapes[4].emitter, 0);
    EXPECT_EQ(std::get<AreaEmitter>(scene.emitters[0].kind).shape, 4);
    EXPECT_EQ(std::get<AreaEmitter>(scene.emitters[0].kind).radiance, Rgb(3.0f));
    EXPECT_EQ(scene.environment(), 1);
}

}  // namespace
}  // namespace treefarm
