// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

using MitsubaShapes = MitsubaFixture;

TEST_F(MitsubaShapes, TransformsApplyInTheirOrder) {
    const auto loaded = load_with_sensor(
        "<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"0\" z=\"0\"/><transform name=\"to_world\">"
        "<rotate z=\"1\" angle=\"90\"/><scale value=\"2\"/><translate value=\"1, 2, 3\"/></transform></shape>",
        "3.0.0");
    const auto& sphere = std::get<Sphere>(loaded.scene.shapes[0].geometry);
    expect_near(sphere.center, Vec3(1, 4, 3));
    EXPECT_NEAR(sphere.radius, 2.0f, 1e-6f);
}

TEST_F(MitsubaShapes, SphereOfVersion0DoesNotScaleItsCentre) {
    const std::string body =
        "<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"0\" z=\"0\"/><float name=\"radius\" value=\"3\"/>"
        "<transform name=\"toWorld\"><scale x=\"-2\" y=\"2\" z=\"2\"/></transform></shape>";
    const auto old = load_with_sensor(body);
    expect_near(std::get<Sphere>(old.scene.shapes[0].geometry).center, Vec3(-1, 0, 0));
    EXPECT_FALSE(std::get<Sphere>(old.scene.shapes[0].geometry).flip_normals);
    const auto recent = load_with_sensor(body, "3.0.0");
    expect_near(std::get<Sphere>(recent.scene.shapes[0].geometry).center, Vec3(-2, 0, 0));
    EXPECT_NEAR(std::get<Sphere>(recent.scene.shapes[0].geometry).radius, 6.0f, 1e-6f);
    EXPECT_TRUE(std::get<Sphere>(recent.scene.shapes[0].geometry).flip_normals) << "a mirror turns it inside out";
}

TEST_F(MitsubaShapes, MatrixIsRowByRow) {
    const auto loaded = load_with_sensor(
        "<shape type=\"rectangle\"><transform name=\"toWorld\"><matrix value=\"0 0 1 5  0 1 0 6  -1 0 0 7  0 0 0 1\"/>"
        "</transform></shape>");
    const Mesh& mesh = mesh_of(loaded);
    expect_near(mesh.positions[0], Vec3(5, 5, 8));
    expect_near(triangle_normal(mesh, 0), Vec3(1, 0, 0));
}

TEST_F(MitsubaShapes, RectangleFrontUnderMirrorsAndFlips) {
    const auto normal = [&](const std::string& inside) {
        const auto loaded = load_with_sensor("<shape type=\"rectangle\">" + inside + "</shape>");
        EXPECT_EQ(mesh_of(loaded).triangle_count(), 2u);
        expect_near(triangle_normal(mesh_of(loaded), 0), triangle_normal(mesh_of(loaded), 1));
        return triangle_normal(mesh_of(loaded), 0);
    };
    const std::string mirror = "<transform name=\"toWorld\"><scale x=\"-1\"/></transform>";
    const std::string flip = "<boolean name=\"flipNormals\" value=\"true\"/>";
    expect_near(normal(""), Vec3(0, 0, 1));
    expect_near(normal(mirror), Vec3(0, 0, 1));
    expect_near(normal(flip), Vec3(0, 0, -1));
    expect_near(normal(mirror + flip), Vec3(0, 0, -1));
    expect_near(normal("<transform name=\"toWorld\"><scale z=\"-1\"/></transform>"), Vec3(0, 0, -1));
}

TEST_F(MitsubaShapes, CubeFacesOutwards) {
    for (const char* scale : {"1", "-1"}) {
        const auto loaded = load_with_sensor("<shape type=\"cube\"><transform name=\"toWorld\"><scale x=\"" +
                                             std::string(scale) + "\" y=\"2\" z=\"3\"/></transform></shape>");
        const Mesh& mesh = mesh_of(loaded);
        ASSERT_EQ(mesh.triangle_count(), 12u);
        float area = 0.0f;
        for (std::size_t i = 0; i < 12; ++i) {
            const Vec3 a = mesh.positions[mesh.indices[3 * i]], b = mesh.positions[mesh.indices[3 * i + 1]],
                       c = mesh.positions[mesh.indices[3 * i + 2]];
            EXPECT_GT(dot(triangle_normal(mesh, i), a), 0.9f);
            area += cross(b - a, c - a).length() / 2;
        }
        EXPECT_NEAR(area, 2 * (2 * 4 + 2 * 6 + 4 * 6), 1e-4f);
    }
}

TEST_F(MitsubaShapes, EllipsoidsAreRefused) {
    EXPECT_THROW(
        load_with_sensor("<shape type=\"sphere\"><transform name=\"toWorld\"><scale x=\"2\"/></transform></shape>"),
        InputError);
}

}  // namespace
}  // namespace treefarm
