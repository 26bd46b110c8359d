// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>

#include "coordinator/input/load.h"
#include "coordinator/input/meshes/obj_file.h"
#include "coordinator/input/meshes/triangulate.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

class Obj : public test::FolderTest {
  protected:
    ObjFile read(const std::string& text) const { return read_obj(write("m.obj", text), {"scene.xml", 5, 6}); }

    /// The message without the folder.
    std::string message_of(const std::string& text) const {
        try {
            read(text);
        } catch (const InputError& error) {
            const std::string message = error.what(), file = (folder_ / "m.obj").string();
            return message.find(file) == 0 ? message.substr(file.size()) : message;
        }
        return "no error";
    }

    /// The mesh of a shape with this file and these properties.
    Mesh mesh(const std::string& text, const std::string& properties, const std::string& version = "0.6.0") const {
        write("m.obj", text);
        std::ofstream(folder_ / "s.xml") << "<scene version=\"" << version << "\"><sensor type=\"perspective\"/>"
                                         << "<shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/>"
                                         << properties << "</shape></scene>";
        return std::get<Mesh>(load_scene(folder_ / "s.xml").scene.shapes.at(0).geometry);
    }
};

Vec3 normal_of(const Mesh& mesh, std::size_t i) {
    const Vec3 a = mesh.positions[mesh.indices[3 * i]], b = mesh.positions[mesh.indices[3 * i + 1]],
               c = mesh.positions[mesh.indices[3 * i + 2]];
    return normalize(cross(b - a, c - a));
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kMirror = "<transform name=\"toWorld\"><scale x=\"-1\"/></transform>";
const std::string kFlip = "<boolean name=\"flipNormals\" value=\"true\"/>";
const std::string kFaces = "<boolean name=\"faceNormals\" value=\"true\"/>";

TEST_F(Obj, AllFormsOfCorners) {
    const ObjFile obj = read("# comment\n\n" + kTriangle +
                             "vt 0.5 0.25\nvt 1\nvn 0 0 2\ng a b\ns off\nusemtl x\n"
                             "f 1 2 3\nf 1/1 2/2 3/1\nf 1//1 2//1 3//1\nf -3/-2/-1 -2/1/1 \\\n -1/1/1 # end\nl 1 2\n");
    ASSERT_EQ(obj.corners.size(), 12u);
    EXPECT_EQ(obj.corners[0].uv, ObjFile::Corner::kMissing);
    EXPECT_EQ(obj.corners[4].uv, 1u);
    EXPECT_EQ(obj.corners[4].normal, ObjFile::Corner::kMissing);
    EXPECT_EQ(obj.corners[6].normal, 0u);
    EXPECT_EQ(obj.corners[9].position, 0u);
    EXPECT_EQ(obj.corners[9].uv, 0u);
    EXPECT_EQ(obj.corners[11].position, 2u);
    EXPECT_EQ(obj.uvs[1], Vec2(1, 0));
    EXPECT_EQ(obj.normals[0], Vec3(0, 0, 2));
}

TEST_F(Obj, WindowsLineEndsAndMissingLastLineEnd) {
    EXPECT_EQ(read("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3").corners.size(), 3u);
}

TEST_F(Obj, ErrorsHaveTheirLocation) {
    EXPECT_EQ(message_of("v 0 0 0\nv 1 zero 0\n"), ":2:5: \"zero\" is not a number; write a finite decimal number");
    EXPECT_EQ(message_of("v 0 0 nan\n").substr(0, 7), ":1:7: \"");
    EXPECT_EQ(message_of("v 0 0 1e39\n").substr(0, 7), ":1:7: \"");
    EXPECT_EQ(message_of("v 0 0 0,5\n").substr(0, 7), ":1:7: \"");
    EXPECT_EQ(message_of("v 0 0\n").substr(0, 5), ":1:5:");
    EXPECT_EQ(message_of(kTriangle + "f 1 2 4\n"),
              ":4:7: vertex 4 of 3; the file is cut short or has a wrong index: repair it");
    EXPECT_EQ(message_of(kTriangle + "f 1 2 -4\n").substr(0, 5), ":4:7:");
    EXPECT_EQ(message_of(kTriangle + "f 1 2 0\n").substr(0, 5), ":4:7:");
    EXPECT_EQ(message_of(kTriangle + "f 1 2 x\n").substr(0, 5), ":4:7:");
    EXPECT_EQ(message_of(kTriangle + "f 1 2 99999999999\n").substr(0, 5), ":4:7:");
    EXPECT_EQ(message_of(kTriangle + "f 1/1 2/1 3/1\n").substr(0, 26), ":4:3: texture coordinate 1");
    EXPECT_EQ(message_of(kTriangle + "f 1//1 2 3\n").substr(0, 14), ":4:3: normal 1");
    EXPECT_EQ(message_of(kTriangle + "f\n").substr(0, 28), ":4:1: a face without corners");
    EXPECT_EQ(read(kTriangle + "f 1 2\nf 1 2 3\n").flat_faces, 1u) << "Mitsuba leaves it out, too";
    EXPECT_EQ(message_of("solid ascii\n").substr(0, 13), ":1:1: \"solid\"");
    EXPECT_EQ(message_of(std::string("\0\1\2\3", 4)).substr(0, 5), ":1:1:");
    EXPECT_NE(message_of(kTriangle + "f 1 2 3 9\n").find(":4:"), std::string::npos);
    EXPECT_THROW(read_obj(folder_ / "none.obj", {"scene.xml", 5, 6}), InputError);
    EXPECT_THROW(read_obj(folder_, {"scene.xml", 5, 6}), InputError);
}

TEST_F(Obj, EveryCutIsReadOrRefused) {
    const std::string whole = kTriangle + "vt 0 1\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n";
    for (std::size_t n = 0; n <= whole.size(); ++n) {
        try {
            read(whole.substr(0, n));
        } catch (const InputError&) {
        }
    }
}

TEST_F(Obj, FlatMeshesNeedNoNormals) {
    EXPECT_TRUE(mesh(kTriangle + "f 1 2 3\n", "").normals.empty());
    EXPECT_TRUE(mesh(kTriangle + "vn 0 0 3\nf 1//1 2//1 3//1\n", "").normals.empty());
}

TEST_F(Obj, SmoothNormalsUnlessFaceNormals) {
    // A ridge along the x axis: its two vertices get the mean of both sides.
    const std::string ridge = "v 0 0 0\nv 1 0 0\nv 0 1 -1\nv 0 -1 -1\nf 1 2 3\nf 2 1 4\n";
    const Mesh smooth = mesh(ridge, "");
    ASSERT_EQ(smooth.positions.size(), 4u);
    ASSERT_EQ(smooth.normals.size(), 4u);
    EXPECT_LT((smooth.normals[1] - Vec3(0, 0, 1)).length(), 1e-5f);
    EXPECT_TRUE(mesh(ridge, kFaces).normals.empty());
    const Mesh flipped = mesh(ridge, kFlip);
    EXPECT_LT((flipped.normals[1] - Vec3(0, 0, -1)).length(), 1e-5f);
    EXPECT_LT(normal_of(flipped, 0).z, 0.0f);
    EXPECT_LT(normal_of(mesh(ridge, kFlip + kFaces), 0).z, 0.0f);
}

TEST_F(Obj, GroupsOfVersion0AreNotSmoothedTogether) {
    const std::string ridge = "v 0 0 0\nv 1 0 0\nv 0 1 -1\nv 0 -1 -1\nf 1 2 3\ng other\nf 2 1 4\n";
    EXPECT_TRUE(mesh(ridge, "").normals.empty());
    EXPECT_FALSE(mesh(ridge, "<boolean name=\"collapse\" value=\"true\"/>").normals.empty());
    EXPECT_FALSE(mesh(ridge, "", "3.0.0").normals.empty());
}

TEST_F(Obj, NormalsDecideTheFront) {
    const std::string against = kTriangle + "vn 0 0 -1\nf 1//1 2//1 3//1\n";
    EXPECT_LT(normal_of(mesh(against, ""), 0).z, 0.0f);
    EXPECT_LT(normal_of(mesh(against, kMirror), 0).z, 0.0f);
    EXPECT_GT(normal_of(mesh(against, kFlip), 0).z, 0.0f);
    EXPECT_GT(normal_of(mesh(against, kFaces), 0).z, 0.0f) << "face normals go by the winding";
}

TEST_F(Obj, MirrorsOfFilesWithoutNormals) {
    EXPECT_LT(normal_of(mesh(kTriangle + "f 1 2 3\n", kMirror), 0).z, 0.0f)
        << "Mitsuba 0.6 goes by the winding in the world";
    EXPECT_GT(normal_of(mesh(kTriangle + "f 1 2 3\n", kMirror, "3.0.0"), 0).z, 0.0f)
        << "Mitsuba 3 keeps the outside outside";
}

TEST_F(Obj, TextureCoordinatesAreFlipped) {
    const std::string text = kTriangle + "vt 0.25 0.25\nf 1/1 2/1 3/1\n";
    EXPECT_EQ(mesh(text, "").uvs[0], Vec2(0.25f, 0.75f));
    EXPECT_EQ(mesh(text, "<boolean name=\"flipTexCoords\" value=\"false\"/>").uvs[0], Vec2(0.25f, 0.25f));
}

double area_of(const std::vector<Vec3>& polygon, const std::vector<std::array<std::size_t, 3>>& triangles,
               const Vec3& normal) {
    double area = 0.0;
    for (const auto& [a, b, c] : triangles) {
        const double part = dot(cross(polygon[b] - polygon[a], polygon[c] - polygon[a]), normal) / 2;
        EXPECT_GE(part, 0.0) << "a triangle is turned round";
        area += part;
    }
    return area;
}

TEST(Triangulate, ConvexIsAFan) {
    const std::vector<Vec3> square = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
    std::vector<std::array<std::size_t, 3>> triangles;
    ASSERT_TRUE(triangulate(square, triangles));
    EXPECT_EQ(triangles, (std::vector<std::array<std::size_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulate, ConcaveKeepsAreaAndOrientation) {
    // An L of area 3 in the plane x = 2, seen from -x, begun at each of its corners.
    const std::vector<Vec3> l = {Vec3(2, 0, 0), Vec3(2, 0, 2), Vec3(2, 1, 2),
                                 Vec3(2, 1, 1), Vec3(2, 2, 1), Vec3(2, 2, 0)};
    for (std::size_t start = 0; start < l.size(); ++start) {
        std::vector<Vec3> turned;
        for (std::size_t i = 0; i < l.size(); ++i)
            turned.push_back(l[(start + i) % l.size()]);
        std::vector<std::array<std::size_t, 3>> triangles;
        ASSERT_TRUE(triangulate(turned, triangles));
        EXPECT_EQ(triangles.size(), 4u);
        EXPECT_NEAR(area_of(turned, triangles, Vec3(-1, 0, 0)), 3.0, 1e-6);
    }
}

TEST(Triangulate, HugeConcaveFacesAreRefused) {
    std::vector<Vec3> comb;
    for (int i = 0; i < 300; ++i)
        comb.emplace_back(static_cast<float>(i), i % 2 == 0 ? 1.0f : 2.0f, 0.0f);
    comb.emplace_back(299.0f, 5.0f, 0.0f);
    comb.emplace_back(0.0f, 5.0f, 0.0f);
    std::vector<std::array<std::size_t, 3>> triangles;
    EXPECT_FALSE(triangulate(comb, triangles));
}

TEST(Triangulate, DegeneratePolygonsEnd) {
    const std::vector<Vec3> bow = {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, point(7, Vec3(1, 2, 3));
    std::vector<std::array<std::size_t, 3>> triangles;
    EXPECT_TRUE(triangulate(bow, triangles));
    EXPECT_TRUE(triangulate(point, triangles));
    EXPECT_EQ(triangles.size(), 2u + 5u);
}

}  // namespace
}  // namespace treefarm
