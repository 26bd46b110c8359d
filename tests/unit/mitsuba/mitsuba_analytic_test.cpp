// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

/// Spheres, disks, cylinders and cubes: sides and texture coordinates under mirrors and flips.
class MitsubaAnalytic : public MitsubaFixture {
  protected:
    template <class Kind>
    Kind shape(const std::string& type, const std::string& inside, const std::string& version = "0.6.0") const {
        const auto loaded = load_with_sensor("<shape type=\"" + type + "\">" + inside + "</shape>", version);
        return std::get<Kind>(loaded.scene.shapes.at(0).geometry);
    }
};

const std::string kMirror = "<transform name=\"toWorld\"><scale x=\"-1\"/></transform>";
const std::string kFlip = "<boolean name=\"flipNormals\" value=\"true\"/>";

Vec3 front(const Disk& disk) {
    return normalize(cross(disk.half_u, disk.half_v));
}

TEST_F(MitsubaAnalytic, DiskFrontIsWhereZGoes) {
    for (const char* version : {"0.6.0", "3.0.0"}) {
        const auto disk = [&](const std::string& inside) { return shape<Disk>("disk", inside, version); };
        expect_near(front(disk("")), Vec3(0, 0, 1));
        expect_near(front(disk(kMirror)), Vec3(0, 0, 1));
        expect_near(front(disk(kFlip)), Vec3(0, 0, -1));
        expect_near(front(disk(kMirror + kFlip)), Vec3(0, 0, -1));
        expect_near(front(disk("<transform name=\"toWorld\"><scale z=\"-2\"/></transform>")), Vec3(0, 0, -1));
        expect_near(front(disk("<transform name=\"toWorld\"><rotate x=\"1\" angle=\"90\"/></transform>")),
                    Vec3(0, -1, 0));
    }
}

TEST_F(MitsubaAnalytic, DiskAzimuthStaysWithTheObject) {
    // The point a = b of the object has the azimuth 1/8, whichever side is the front.
    for (const std::string& inside : {std::string(), kMirror, kFlip, kMirror + kFlip}) {
        const auto disk = shape<Disk>("disk", inside);
        const bool is_mirror = inside.find("scale") != std::string::npos;
        const Vec3 point(is_mirror ? -0.5f : 0.5f, 0.5f, 0.0f);
        const float a = dot(point, disk.half_u), b = dot(point, disk.half_v) * (disk.mirrored ? -1.0f : 1.0f);
        EXPECT_NEAR(std::atan2(b, a), kPi / 4, 1e-5f) << inside;
    }
}

TEST_F(MitsubaAnalytic, DiskUnderAnyTransformation) {
    const auto disk = shape<Disk>("disk",
                                  "<transform name=\"to_world\"><scale x=\"2\" y=\"3\"/><rotate z=\"1\" angle=\"90\"/>"
                                  "<translate x=\"5\"/></transform>",
                                  "3.0.0");
    expect_near(disk.center, Vec3(5, 0, 0));
    expect_near(disk.half_u, Vec3(0, 2, 0));
    expect_near(disk.half_v, Vec3(-3, 0, 0));
    EXPECT_FALSE(disk.mirrored);
}

TEST_F(MitsubaAnalytic, CylinderIsPlacedAndScaled) {
    const auto cylinder =
        shape<Cylinder>("cylinder",
                        "<point name=\"p0\" x=\"1\" y=\"0\" z=\"0\"/><point name=\"p1\" x=\"1\" y=\"0\" z=\"2\"/>"
                        "<float name=\"radius\" value=\"0.5\"/>"
                        "<transform name=\"toWorld\"><scale x=\"2\" y=\"2\" z=\"3\"/><translate y=\"1\"/></transform>");
    expect_near(cylinder.p0, Vec3(2, 1, 0));
    expect_near(cylinder.p1, Vec3(2, 1, 6));
    EXPECT_NEAR(cylinder.radius, 1.0f, 1e-6f);
    expect_near(cylinder.meridian, Vec3(1, 0, 0));
    EXPECT_FALSE(cylinder.flip_normals);
    EXPECT_FALSE(cylinder.mirrored);
}

TEST_F(MitsubaAnalytic, MirroredCylinderTurnsInsideOutInVersion0Only) {
    EXPECT_TRUE(shape<Cylinder>("cylinder", kMirror).flip_normals);
    EXPECT_FALSE(shape<Cylinder>("cylinder", kMirror + kFlip).flip_normals);
    EXPECT_FALSE(shape<Cylinder>("cylinder", kMirror, "3.0.0").flip_normals);
    EXPECT_TRUE(shape<Cylinder>("cylinder", kFlip, "3.0.0").flip_normals);
    for (const char* version : {"0.6.0", "3.0.0"}) {
        const auto cylinder = shape<Cylinder>("cylinder", kMirror, version);
        EXPECT_TRUE(cylinder.mirrored);
        expect_near(cylinder.meridian, Vec3(-1, 0, 0));
    }
}

TEST_F(MitsubaAnalytic, CylinderMeridianByVersion) {
    const std::string along_x = "<point name=\"p1\" x=\"4\" y=\"0\" z=\"0\"/>";
    // coordinateSystem() of (1, 0, 0): c = (0, 0, -1), b = c x a = (0, -1, 0).
    expect_near(shape<Cylinder>("cylinder", along_x).meridian, Vec3(0, -1, 0));
    // Duff et al. of (1, 0, 0): a = -1, s = (-1 + 1, 0, -1).
    expect_near(shape<Cylinder>("cylinder", along_x, "3.0.0").meridian, Vec3(0, 0, -1));
}

TEST_F(MitsubaAnalytic, CylindersThatAreNoneAreRefused) {
    const auto refused = [&](const std::string& inside) {
        EXPECT_THROW(shape<Cylinder>("cylinder", inside), InputError) << inside;
    };
    refused("<transform name=\"toWorld\"><scale x=\"2\"/></transform>");
    refused("<transform name=\"toWorld\"><matrix value=\"1 0 1 0  0 1 0 0  0 0 1 0  0 0 0 1\"/></transform>");
    refused("<point name=\"p1\" x=\"0\" y=\"0\" z=\"0\"/>");
    refused("<float name=\"radius\" value=\"0\"/>");
    refused("<float name=\"radius\" value=\"nan\"/>");
    EXPECT_THROW(shape<Cylinder>("cylinder", "<point name=\"p2\" x=\"0\" y=\"0\" z=\"1\"/>", "3.0.0"), InputError);
}

TEST_F(MitsubaAnalytic, SpherePoleAndMeridianTurnWithIt) {
    for (const char* version : {"0.6.0", "3.0.0"}) {
        const auto sphere = shape<Sphere>(
            "sphere", "<transform name=\"toWorld\"><scale value=\"3\"/><rotate x=\"1\" angle=\"90\"/></transform>",
            version);
        expect_near(sphere.pole, Vec3(0, -1, 0));
        expect_near(sphere.meridian, Vec3(1, 0, 0));
        EXPECT_FALSE(sphere.mirrored);
        EXPECT_TRUE(shape<Sphere>("sphere", kMirror, version).mirrored);
    }
}

TEST_F(MitsubaAnalytic, CubeHasMitsubasTextureCoordinates) {
    const auto loaded = load_with_sensor("<shape type=\"cube\"/>");
    const Mesh& mesh = mesh_of(loaded);
    // Of CubeData in cube.cpp: one corner of each side, in the order -y, +y, +x, +z, -x, -z.
    const std::vector<std::pair<Vec3, Vec2>> expected = {{Vec3(1, -1, -1), Vec2(0, 1)}, {Vec3(1, 1, -1), Vec2(0, 1)},
                                                         {Vec3(1, -1, -1), Vec2(0, 1)}, {Vec3(1, -1, 1), Vec2(0, 1)},
                                                         {Vec3(-1, -1, 1), Vec2(0, 1)}, {Vec3(1, 1, -1), Vec2(0, 1)}};
    ASSERT_EQ(mesh.positions.size(), 24u);
    for (std::size_t side = 0; side < 6; ++side)
        for (std::size_t i = 4 * side; i < 4 * side + 4; ++i)
            if (mesh.uvs[i] == expected[side].second) expect_near(mesh.positions[i], expected[side].first);
    // And one along u: (1, -1, 1) has (1, 1) on the side -y.
    EXPECT_EQ(mesh.uvs[2], Vec2(1, 1));
    expect_near(mesh.positions[2], Vec3(1, -1, 1));
}

}  // namespace
}  // namespace treefarm
