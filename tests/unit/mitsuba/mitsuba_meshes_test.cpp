// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mesh_bytes.h"
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

const std::string kMirrored = "<transform name=\"toWorld\"><scale x=\"-1\"/></transform>";
const std::string kFlipped = "<boolean name=\"flipNormals\" value=\"true\"/>";
const std::string kFaceNormals = "<boolean name=\"faceNormals\" value=\"true\"/>";

/// Shapes that read meshes from files.
class MitsubaMeshes : public MitsubaFixture {
  protected:
    Mesh mesh(const std::string& type, const std::string& properties, const std::string& version = "0.6.0") const {
        const auto loaded = load_with_sensor("<shape type=\"" + type + "\"><string name=\"filename\" value=\"m." +
                                                 type + "\"/>" + properties + "</shape>",
                                             version);
        return mesh_of(loaded);
    }

    std::string message_of(const std::string& body) const {
        try {
            load_with_sensor(body);
        } catch (const InputError& error) {
            const std::string message = error.what(), folder = folder_.string() + "/";
            return message.find(folder) == 0 ? message.substr(folder.size()) : message;
        }
        return "no error";
    }
};

/// A triangle whose front is +z by its winding, with or without normals that say -z.
Mesh triangle(bool normals) {
    Mesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    if (normals) mesh.normals.assign(3, Vec3(0, 0, -2));
    mesh.uvs = {Vec2(0, 0.25f), Vec2(1, 0), Vec2(0, 1)};
    mesh.indices = {0, 1, 2};
    return mesh;
}

std::string ascii_ply(const Mesh& mesh) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\n";
    if (!mesh.normals.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
    text += "property float u\nproperty float v\nelement face " + std::to_string(mesh.indices.size() / 3) +
            "\nproperty list uchar int vertex_indices\nend_header\n";
    const auto add = [&](const auto& v) {
        for (unsigned i = 0; i < v.dimensions(); ++i)
            text += std::to_string(v[static_cast<int>(i)]) + " ";
    };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        add(mesh.positions[i]);
        if (!mesh.normals.empty()) add(mesh.normals[i]);
        add(mesh.uvs[i]);
        text += "\n";
    }
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        text += "3 " + std::to_string(mesh.indices[i]) + " " + std::to_string(mesh.indices[i + 1]) + " " +
                std::to_string(mesh.indices[i + 2]) + "\n";
    return text;
}

TEST_F(MitsubaMeshes, PlyFrontByVersion) {
    write("m.ply", ascii_ply(triangle(false)));
    expect_near(triangle_normal(mesh("ply", ""), 0), Vec3(0, 0, 1));
    expect_near(triangle_normal(mesh("ply", kFlipped), 0), Vec3(0, 0, -1));
    expect_near(triangle_normal(mesh("ply", kMirrored), 0), Vec3(0, 0, -1));
    expect_near(triangle_normal(mesh("ply", kMirrored, "3.0.0"), 0), Vec3(0, 0, 1));
    write("m.ply", ascii_ply(triangle(true)));
    for (const char* version : {"0.6.0", "3.0.0"}) {
        expect_near(triangle_normal(mesh("ply", "", version), 0), Vec3(0, 0, -1));
        expect_near(triangle_normal(mesh("ply", kMirrored, version), 0), Vec3(0, 0, -1));
        expect_near(triangle_normal(mesh("ply", kFlipped, version), 0), Vec3(0, 0, 1));
        expect_near(triangle_normal(mesh("ply", kFaceNormals, version), 0), Vec3(0, 0, 1));
    }
}

TEST_F(MitsubaMeshes, PlyTextureCoordinatesAreAsWritten) {
    write("m.ply", ascii_ply(triangle(false)));
    EXPECT_EQ(mesh("ply", "").uvs[0], Vec2(0, 0.25f));
    EXPECT_EQ(mesh("ply", "<boolean name=\"flip_tex_coords\" value=\"true\"/>", "3.0.0").uvs[0], Vec2(0, 0.75f));
}

TEST_F(MitsubaMeshes, SerializedKeepsItsFrontUnderMirrors) {
    write("m.serialized", serialized_file({serialized_payload(triangle(false), 4, false)}, 4));
    for (const char* version : {"0.6.0", "3.0.0"}) {
        expect_near(triangle_normal(mesh("serialized", "", version), 0), Vec3(0, 0, 1));
        expect_near(triangle_normal(mesh("serialized", kMirrored, version), 0), Vec3(0, 0, 1));
        expect_near(triangle_normal(mesh("serialized", kMirrored + kFaceNormals + kFlipped, version), 0),
                    Vec3(0, 0, -1));
    }
}

TEST_F(MitsubaMeshes, SerializedShapeIndex) {
    write("m.serialized",
          serialized_file({serialized_payload(triangle(false), 3, false), serialized_payload(tetrahedron(), 3, false)},
                          3));
    EXPECT_EQ(mesh("serialized", "<integer name=\"shapeIndex\" value=\"1\"/>").triangle_count(), 4u);
    EXPECT_EQ(mesh("serialized", "<integer name=\"shape_index\" value=\"0\"/>", "3.0.0").triangle_count(), 1u);
    const std::string message = message_of(
        "<shape type=\"serialized\"><string name=\"filename\" value=\"m.serialized\"/>\n"
        "<integer name=\"shapeIndex\" value=\"2\"/></shape>");
    EXPECT_EQ(message.substr(0, 37), "scene.xml:4:1: mesh number 2 of 2; gi") << message;
}

TEST_F(MitsubaMeshes, MaxSmoothAngleKeepsSharpEdges) {
    // A ridge: its sides meet in an angle of 90 degrees.
    write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 -1\nv 0 -1 -1\nf 1 2 3\nf 2 1 4\n");
    const auto with_angle = [&](const char* degrees) {
        return mesh("obj", std::string("<float name=\"maxSmoothAngle\" value=\"") + degrees + "\"/>");
    };
    EXPECT_TRUE(with_angle("80").normals.empty()) << "flat on both sides";
    EXPECT_EQ(with_angle("80").positions.size(), 6u);
    const Mesh smooth = with_angle("100");
    EXPECT_EQ(smooth.positions.size(), 4u);
    ASSERT_EQ(smooth.normals.size(), 4u);
    float most = 0.0f;
    for (const Vec3& normal : smooth.normals)
        most = std::max(most, normal.z);
    EXPECT_NEAR(most, 1.0f, 1e-5f) << "the ridge is smooth";
    EXPECT_THROW(mesh("obj", kFaceNormals + "<float name=\"maxSmoothAngle\" value=\"30\"/>"), InputError);
    EXPECT_THROW(mesh("obj", "<float name=\"max_smooth_angle\" value=\"30\"/>", "3.0.0"), InputError);
}

TEST_F(MitsubaMeshes, ObjShapeIndexChoosesAGroup) {
    write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 5\ng a\nusemtl m\nf 1 2 3\ng b\nf 1 2 4\nf 2 3 4\ng c\nf 1 3 4\n");
    EXPECT_EQ(mesh("obj", "").triangle_count(), 4u);
    EXPECT_EQ(mesh("obj", "<integer name=\"shapeIndex\" value=\"1\"/>").triangle_count(), 2u);
    EXPECT_EQ(mesh("obj", "<integer name=\"shapeIndex\" value=\"2\"/>").triangle_count(), 1u);
    EXPECT_THROW(mesh("obj", "<integer name=\"shapeIndex\" value=\"3\"/>"), InputError);
}

TEST_F(MitsubaMeshes, FilesWithoutFacesAndWrongTypes) {
    write("m.ply",
          "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 0\nproperty list uchar int vertex_indices\nend_header\n");
    EXPECT_NE(message_of("<shape type=\"ply\"><string name=\"filename\" value=\"m.ply\"/></shape>").find("no faces"),
              std::string::npos);
    EXPECT_EQ(message_of("<shape type=\"ply\"><string name=\"filename\" value=\"none.ply\"/></shape>").substr(0, 14),
              "scene.xml:3:19");
    EXPECT_EQ(message_of("<shape type=\"serialized\"/>").substr(0, 13), "scene.xml:3:1");
    EXPECT_EQ(message_of("<shape type=\"ply\"><float name=\"filename\" value=\"1\"/></shape>").substr(0, 14),
              "scene.xml:3:19");
    write("m.serialized", "v 0 0 0\n");
    EXPECT_EQ(
        message_of("<shape type=\"serialized\"><string name=\"filename\" value=\"m.serialized\"/></shape>"),
        "m.serialized: there is no serialized mesh (at byte 0); check that the file is Mitsuba's serialized format");
}

}  // namespace
}  // namespace treefarm
