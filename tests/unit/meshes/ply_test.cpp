// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coordinator/input/meshes/ply_file.h"
#include "tests/support/mesh_bytes.h"
#include "tests/support/refusal.h"

namespace treefarm {
namespace {

const std::string kVertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kPlyFaces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kPoints = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string ascii(const std::string& header, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + header + "end_header\n" + body;
}

std::string message_of(const std::string& bytes) {
    return test::refusal_of([&] { parse_ply(bytes, "m.ply"); }, "no error");
}

void expect_ply_refused(const std::string& bytes, const std::string& begin) {
    EXPECT_EQ(message_of(bytes).substr(0, begin.size()), begin) << message_of(bytes);
}

TEST(Ply, ColoursOfVerticesAndFaces) {
    const std::string positions = "property float x\nproperty float y\nproperty float z\n";
    const Mesh mesh = parse_ply(ascii("element vertex 4\nproperty uchar blue\n" + positions +
                                          "property uchar red\nproperty uchar green\nproperty uchar alpha\n"
                                          "element face 2\nproperty float b\nproperty list uchar int vertex_indices\n"
                                          "property float r\nproperty float g\n",
                                      "255 0 0 0 0 128 9\n0 1 0 0 255 0 9\n0 1 1 0 0 0 9\n0 0 1 0 0 0 9\n"
                                      "3 3 0 1 2 1 2\n-0.5 4 0 1 2 3 0.25 0.5\n"),
                                "m.ply");
    const MeshAttribute* vertices = mesh.find_attribute("vertex_color");
    const MeshAttribute* faces = mesh.find_attribute("face_color");
    ASSERT_TRUE(vertices && faces);
    ASSERT_EQ(vertices->values.size(), 4u);
    EXPECT_EQ(vertices->values[0].x, 0.0f);
    EXPECT_NEAR(vertices->values[0].y, 0.2158605f, 1e-6f) << "integers are sRGB";
    EXPECT_EQ(vertices->values[0].z, 1.0f);
    EXPECT_EQ(vertices->values[1], Rgb(1, 0, 0));
    EXPECT_EQ(faces->values, (std::vector<Rgb>{Rgb(1, 2, 3), Rgb(0.25f, 0.5f, -0.5f), Rgb(0.25f, 0.5f, -0.5f)}))
        << "floats are linear; a polygon's colour is that of all its triangles";
    EXPECT_TRUE(parse_ply(ascii(kVertices + kPlyFaces, kPoints + "4 0 1 2 3\n"), "m.ply").attributes.empty());
}

TEST(Ply, AnAttributeThatIsNoNumberMattersToWhoAsksForItOnly) {
    const Mesh mesh = parse_ply(ascii("element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                                      "property float wear_0\nproperty uchar age_0\n" +
                                          kPlyFaces,
                                      "0 0 0 nan 0\n1 0 0 -inf x\n0 1 0 1 255\n3 0 1 2\n"),
                                "m.ply");
    EXPECT_TRUE(std::isnan(mesh.find_attribute("vertex_wear")->values.at(0).x));
    EXPECT_TRUE(std::isnan(mesh.find_attribute("vertex_age")->values.at(1).x));
    EXPECT_EQ(mesh.find_attribute("vertex_age")->values.at(2), Rgb(1.0f));
}

TEST(Ply, AttributesAreNamedAsTheirPropertiesBegin) {
    const Mesh mesh = parse_ply(
        ascii(
            "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "property float tint_r\nproperty float tint_g\nproperty float tint_b\nproperty float tint_a\n"
            "property float wear_0\nproperty float wind_1\nproperty float wind_2\nproperty float wind_3\n"
            "property float pair_x\nproperty float pair_y\nproperty float quality\nproperty float late_2\n"
            "element face 1\nproperty list uchar int vertex_indices\nproperty float id_x\n",
            "0 0 0 1 2 3 9 4 5 6 7 8 9 9 9\n1 0 0 0 0 0 9 0 0 0 0 8 9 9 9\n0 1 0 0 0 0 9 0 0 0 0 8 9 9 9\n3 0 1 2 8\n"),
        "m.ply");
    std::vector<std::string> names;
    for (const MeshAttribute& attribute : mesh.attributes)
        names.push_back(attribute.name);
    EXPECT_EQ(names,
              (std::vector<std::string>{"vertex_tint", "vertex_tint_color", "vertex_wear", "vertex_wind", "face_id"}))
        << "one or three values; a colour may have an alpha";
    for (const auto& [name, value] : {std::pair("vertex_tint", Rgb(1, 2, 3)),
                                      {"vertex_tint_color", Rgb(1, 2, 3)},
                                      {"vertex_wear", Rgb(4.0f)},
                                      {"vertex_wind", Rgb(5, 6, 7)},
                                      {"face_id", Rgb(8.0f)}})
        EXPECT_EQ(mesh.find_attribute(name)->values.at(0), value) << name;
}

TEST(Ply, AsciiWithWhatNobodyAsksFor) {
    const Mesh mesh =
        parse_ply(ascii("comment hello world\nobj_info x\n"
                        "element vertex 4\nproperty uchar red\nproperty float z\nproperty double y\n"
                        "property float x\nproperty list uchar int links\n"
                        "element edge 1\nproperty int a\nproperty int b\n"
                        "element face 2\nproperty float quality\nproperty list uint8 uint32 vertex_index\n",
                        "255 3 2 1 0\n255 6 5 4 2 9 9\n0 9 8 7 0\n0 0 -1 1e2 1 -3\n0 1\n"
                        "nan 3 0 1 2\n0.5 3 2 1 3\n"),
                  "m.ply");
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[0], Vec3(1, 2, 3));
    EXPECT_EQ(mesh.positions[3], Vec3(100, -1, 0));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Ply, AsciiWithWindowsLineEndsAndNoLastOne) {
    std::string text = ascii(kVertices + kPlyFaces, kPoints + "3 0 1 2");
    std::string windows;
    for (const char c : text)
        windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(parse_ply(windows, "m.ply").indices.size(), 3u);
    EXPECT_EQ(parse_ply(text, "m.ply").indices.size(), 3u);
    EXPECT_EQ(parse_ply(text + "\n\n \n", "m.ply").indices.size(), 3u);
}

TEST(Ply, BinaryOfBothByteOrders) {
    const Mesh expected = test::tetrahedron();
    for (const bool big_endian : {false, true}) {
        const Mesh mesh = parse_ply(test::binary_ply(expected, big_endian), "m.ply");
        EXPECT_EQ(mesh.positions, expected.positions);
        EXPECT_EQ(mesh.normals, expected.normals);
        EXPECT_EQ(mesh.uvs, expected.uvs);
        EXPECT_EQ(mesh.indices, expected.indices);
    }
}

TEST(Ply, EveryTypeInBothByteOrders) {
    for (const bool big : {false, true}) {
        std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                            "_endian 1.0\nelement vertex 3\nproperty char x\nproperty ushort y\nproperty double z\n"
                            "property short nx\nproperty int ny\nproperty uint nz\n"
                            "element face 1\nproperty list int short vertex_indices\nend_header\n";
        for (int i = 0; i < 3; ++i) {
            test::append<std::int8_t>(bytes, -5);
            test::append<std::uint16_t>(bytes, 60000, big);
            test::append<double>(bytes, 0.25, big);
            test::append<std::int16_t>(bytes, -300, big);
            test::append<std::int32_t>(bytes, -70000, big);
            test::append<std::uint32_t>(bytes, 3000000000u, big);
        }
        test::append<std::int32_t>(bytes, 3, big);
        for (const std::int16_t i : std::initializer_list<std::int16_t>{0, 1, 2})
            test::append<std::int16_t>(bytes, i, big);
        const Mesh mesh = parse_ply(bytes, "m.ply");
        EXPECT_EQ(mesh.positions[2], Vec3(-5, 60000, 0.25f));
        EXPECT_EQ(mesh.normals[2], Vec3(-300, -70000, 3e9f));
    }
}

TEST(Ply, NamesOfTextureCoordinates) {
    for (const auto& [u, v] : {std::pair("u", "v"), std::pair("s", "t"), std::pair("texture_u", "texture_v")}) {
        const std::string header = kVertices + "property float " + v + "\nproperty float " + u + "\n" + kPlyFaces;
        const Mesh mesh = parse_ply(ascii(header, "0 0 0 .5 .25\n1 0 0 0 0\n1 1 0 0 0\n0 1 0 0 0\n3 0 1 2\n"), "m.ply");
        ASSERT_EQ(mesh.uvs.size(), 4u) << u;
        EXPECT_EQ(mesh.uvs[0], Vec2(0.25f, 0.5f));
    }
    // Half of a pair is none.
    EXPECT_TRUE(
        parse_ply(ascii(kVertices + "property float u\n" + kPlyFaces, "0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n3 0 1 2\n"),
                  "m.ply")
            .uvs.empty());
}

TEST(Ply, PolygonsAreCut) {
    const Mesh mesh = parse_ply(ascii(kVertices + kPlyFaces, kPoints + "4 0 1 2 3\n"), "m.ply");
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST(Ply, HeaderErrorsHaveTheirLine) {
    expect_ply_refused("", "m.ply:");
    expect_ply_refused("solid\n", "m.ply:1:1: this is no PLY file");
    expect_ply_refused("ply\nformat ascii 2.0\n", "m.ply:2:14: unknown version");
    expect_ply_refused("ply\nformat text 1.0\n", "m.ply:2:8: unknown format");
    expect_ply_refused("ply\nelement vertex 3\n", "m.ply:2:1: the second line");
    expect_ply_refused("ply\nformat ascii 1.0\nelement vertex\n", "m.ply:3:1: an element has");
    expect_ply_refused("ply\nformat ascii 1.0\nelement vertex -3\n", "m.ply:3:16: \"-3\" is no count");
    expect_ply_refused("ply\nformat ascii 1.0\nproperty float x\n", "m.ply:3:1: a property stands before");
    expect_ply_refused(ascii(kVertices + "property flaot u\n", ""), "m.ply:7:10: unknown type \"flaot\"");
    expect_ply_refused(ascii(kVertices + "property float x\n", ""), "m.ply:7:16: the property \"x\" is declared twice");
    expect_ply_refused(ascii(kVertices + "property list float int l\n", ""), "m.ply:7:15: the length of a list");
    expect_ply_refused(ascii(kVertices + kVertices, ""), "m.ply:7:9: the element \"vertex\" is declared twice");
    expect_ply_refused("ply\nformat ascii 1.0\n" + kVertices + kPlyFaces, "m.ply:8:1: the header has no end");
    expect_ply_refused(ascii("elemant vertex 3\n", ""), "m.ply:3:1: \"elemant\" is no statement");
    expect_ply_refused(ascii(kVertices, kPoints), "m.ply:1:1: the file has no element \"face\"");
    expect_ply_refused(ascii(kPlyFaces + kVertices, "3 0 1 2\n" + kPoints), "m.ply:3:1: the faces stand before");
    expect_ply_refused(
        ascii(kVertices + "element face 1\nproperty list uchar float vertex_indices\n", kPoints + "3 0 1 2\n"),
        "m.ply:8:1: the vertices of faces are no integers");
    expect_ply_refused(ascii(kVertices + "element face 1\nproperty int vertex_indices\n", kPoints + "3\n"),
                       "m.ply:8:1: the faces have no list");
    expect_ply_refused(ascii("element vertex 1\nproperty float x\nproperty float y\n" + kPlyFaces, "0 0\n3 0 0 0\n"),
                       "m.ply:3:1: the vertices have no x, y and z");
}

TEST(Ply, TextErrorsHaveTheirLocation) {
    const std::string header = kVertices + kPlyFaces;  // the data begin in line 10
    EXPECT_EQ(message_of(ascii(header, "0 0 0\n1 zero 0\n1 1 0\n0 1 0\n3 0 1 2\n")),
              "m.ply:11:3: \"zero\" is not a number; write a finite decimal number");
    expect_ply_refused(ascii(header, "0 0 nan\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), "m.ply:10:5: \"nan\"");
    expect_ply_refused(ascii(header, "0 0 1e39\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), "m.ply:10:5: a vertex has a value");
    expect_ply_refused(ascii(header, "0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), "m.ply:10:4: a value is missing");
    expect_ply_refused(ascii(header, "0 0 0 7\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), "m.ply:10:7: there are more values");
    expect_ply_refused(ascii(header, kPoints + "3 0 1 4\n"), "m.ply:14:7: vertex 4 of 4");
    expect_ply_refused(ascii(header, kPoints + "3 0 1 -1\n"), "m.ply:14:7: vertex -1 of 4");
    expect_ply_refused(ascii(header, kPoints + "3 0 1 1.5\n"), "m.ply:14:7: \"1.5\" is not an integer");
    expect_ply_refused(ascii(header, kPoints + "2 0 1\n"), "m.ply:14:1: a face of 2 corners");
    expect_ply_refused(ascii(header, kPoints + "-3 0 1 2\n"), "m.ply:14:1: a list of -3 values");
    expect_ply_refused(ascii(header, kPoints + "4000000000 0 1 2\n"), "m.ply:14:1: a list of 4000000000 values");
    expect_ply_refused(ascii(header, kPoints + "3 0 1 2\n3 0 1 2\n"), "m.ply:15:1: there is more in the file");
}

TEST(Ply, HugeCountsAreRefusedAtOnce) {
    for (const char* format : {"ascii", "binary_little_endian"}) {
        const std::string begin = std::string("ply\nformat ") + format + " 1.0\n";
        expect_ply_refused(
            begin + "element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
            "m.ply:3:1: 4000000000 elements \"vertex\" do not fit into the 0 bytes");
        expect_ply_refused(begin + "element vertex 18446744073709551615\nproperty char x\nend_header\n12",
                           "m.ply:3:1: 18446744073709551615 elements");
    }
    // Elements without properties take no place, so nothing walks over them.
    EXPECT_EQ(
        parse_ply(ascii("element nothing 18446744073709551615\n" + kVertices + kPlyFaces, kPoints + "3 0 1 2\n"), "m")
            .indices.size(),
        3u);
}

TEST(Ply, BinaryErrorsHaveTheirByte) {
    std::string whole = test::binary_ply(test::tetrahedron(), false);
    const std::size_t body = whole.find("end_header\n") + 11;
    std::string damaged = whole;
    const float inf = std::numeric_limits<float>::infinity();
    std::memcpy(damaged.data() + body + 9, &inf, 4);  // after red and x: y
    expect_ply_refused(damaged, "m.ply: a vertex has a value that is not finite in single precision (at byte " +
                                    std::to_string(body + 9) + ")");
    damaged = whole;
    damaged[damaged.size() - 4] = 4;  // the last index
    expect_ply_refused(damaged, "m.ply: vertex 4 of 4 (at byte " + std::to_string(whole.size() - 4) + ")");
    expect_ply_refused(
        whole.substr(0, whole.size() - 1),
        "m.ply: a list of 3 values does not fit into the file (at byte " + std::to_string(whole.size() - 13));
    expect_ply_refused(whole + "x", "m.ply: there is more in the file than the header says (at byte " +
                                        std::to_string(whole.size()) + ")");
    EXPECT_EQ(parse_ply(whole + "\n", "m.ply").indices.size(), 12u);
}

TEST(Ply, EveryCutIsRefused) {
    for (const bool big_endian : {false, true}) {
        const std::string whole = test::binary_ply(test::tetrahedron(), big_endian);
        for (std::size_t n = 0; n < whole.size(); ++n)
            EXPECT_THROW(parse_ply(whole.substr(0, n), "m.ply"), InputError) << n;
    }
}

}  // namespace
}  // namespace treefarm
