// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "coordinator/input/meshes/serialized_file.h"
#include "tests/support/mesh_bytes.h"

namespace treefarm {
namespace {

using test::serialized_file;
using test::serialized_payload;

Mesh parse(const std::string& file, std::int64_t index = 0) {
    std::istringstream in(file);
    return parse_serialized(in, file.size(), index, "m.serialized");
}

void expect_refused(const std::string& file, const std::string& about, std::int64_t index = 0) {
    try {
        parse(file, index);
        ADD_FAILURE() << "accepted, though: " << about;
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).substr(0, 12), "m.serialized");
        EXPECT_NE(std::string(error.what()).find(about), std::string::npos) << error.what();
    }
}

/// A tetrahedron elsewhere.
Mesh moved(float by) {
    Mesh mesh = test::tetrahedron();
    for (Vec3& p : mesh.positions)
        p.x += by;
    return mesh;
}

TEST(Serialized, VersionsAndPrecisions) {
    const Mesh expected = test::tetrahedron();
    for (const int version : {3, 4})
        for (const bool is_double : {false, true})
            for (const bool colors : {false, true}) {
                const Mesh mesh =
                    parse(serialized_file({serialized_payload(expected, version, is_double, colors)}, version));
                EXPECT_EQ(mesh.positions, expected.positions);
                EXPECT_EQ(mesh.normals, expected.normals);
                EXPECT_EQ(mesh.uvs, expected.uvs);
                EXPECT_EQ(mesh.indices, expected.indices);
                ASSERT_EQ(mesh.attributes.size(), colors ? 1u : 0u);
                if (!colors) continue;
                EXPECT_EQ(mesh.attributes[0].name, "vertex_color");
                EXPECT_EQ(mesh.attributes[0].values, std::vector<Rgb>(4, Rgb(0.5f, -2.0f, 3.0f)));
            }
}

TEST(Serialized, NormalsAndTextureCoordinatesMayBeMissing) {
    Mesh expected = test::tetrahedron();
    expected.normals.clear();
    EXPECT_TRUE(parse(serialized_file({serialized_payload(expected, 4, false)}, 4)).normals.empty());
    EXPECT_EQ(parse(serialized_file({serialized_payload(expected, 4, false)}, 4)).uvs, expected.uvs);
    expected.uvs.clear();
    EXPECT_TRUE(parse(serialized_file({serialized_payload(expected, 4, false)}, 4)).uvs.empty());
}

TEST(Serialized, TableOfMeshes) {
    for (const int version : {3, 4}) {
        std::vector<std::string> payloads;
        for (const float by : {0.0f, 10.0f, 20.0f})
            payloads.push_back(serialized_payload(moved(by), version, false));
        const std::string file = serialized_file(payloads, version);
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(parse(file, i).positions[0].x, 1.0f + 10.0f * static_cast<float>(i));
        expect_refused(file, "mesh number 3 of 3", 3);
    }
}

TEST(Serialized, LargeMeshesComeInPieces) {
    Mesh grid;
    for (int i = 0; i < 100'000; ++i)
        grid.positions.emplace_back(static_cast<float>(i), 0.5f, -1.0f);
    for (std::uint32_t i = 0; i + 2 < 100'000; ++i)
        for (const std::uint32_t k : {i, i + 1, i + 2})
            grid.indices.push_back(k);
    const Mesh mesh = parse(serialized_file({serialized_payload(grid, 4, true)}, 4));
    EXPECT_EQ(mesh.positions, grid.positions);
    EXPECT_EQ(mesh.indices, grid.indices);
}

TEST(Serialized, OtherFilesAreRefused) {
    expect_refused("", "at byte 0");
    expect_refused("\x1c", "at byte 0");
    expect_refused("solid text that is no mesh", "there is no serialized mesh (at byte 0)");
    const std::string payload = serialized_payload(test::tetrahedron(), 4, false);
    expect_refused(serialized_file({payload}, 5), "unknown version 5");
    expect_refused(serialized_file({payload}, 4).substr(0, 4), "");
}

TEST(Serialized, DamagedTables) {
    const std::string payload = serialized_payload(test::tetrahedron(), 4, false);
    std::string file = serialized_file({payload, payload}, 4);
    std::string damaged = file;
    damaged.replace(file.size() - 4, 4, "\xff\xff\xff\xff");
    expect_refused(damaged, "the table of 4294967295 meshes", 1);
    damaged = file;
    damaged.replace(file.size() - 12, 8, "\xff\xff\xff\xff\xff\xff\xff\xff");
    expect_refused(damaged, "at byte 18446744073709551615", 1);
    damaged.replace(file.size() - 12, 8, std::string("\x07\0\0\0\0\0\0\0", 8));
    expect_refused(damaged, "there is no serialized mesh (at byte 7)", 1);
}

TEST(Serialized, HugeCountsAreRefusedAtOnce) {
    for (const std::size_t at : {std::size_t{9}, std::size_t{17}})  // vertices, triangles
        for (const std::uint64_t count :
             {std::uint64_t{4'000'000'000}, std::uint64_t{2'000'000'000}, ~std::uint64_t{0}}) {
            std::string payload = serialized_payload(test::tetrahedron(), 4, false);
            std::memcpy(payload.data() + at, &count, 8);
            expect_refused(serialized_file({payload}, 4), count >> 31 ? "more than 2^31" : "do not fit into the file");
        }
}

TEST(Serialized, DamagedMeshes) {
    const std::string payload = serialized_payload(test::tetrahedron(), 4, false);
    const auto refused = [](const std::string& bytes, const std::string& about) {
        expect_refused(serialized_file({bytes}, 4), about);
    };
    std::string damaged = payload;
    damaged[payload.size() - 4] = 4;
    refused(damaged, "vertex 4 of 4");
    const float nan = std::numeric_limits<float>::quiet_NaN();
    damaged = payload;
    std::memcpy(damaged.data() + 25 + 12, &nan, 4);
    refused(damaged, "vertex 1 has a value that is not finite");
    refused(payload + "x", "more values than its header says");
    refused(payload.substr(0, payload.size() - 1), "fewer values than its header says");
    std::string doubles = serialized_payload(test::tetrahedron(), 4, true);
    const double large = 1e300;
    std::memcpy(doubles.data() + 25, &large, 8);
    refused(doubles, "vertex 0 has a value that is not finite");
    std::string endless(70000, 'n');
    endless.insert(0, 4, '\0');
    refused(endless, "name has no end");
}

TEST(Serialized, EveryCutAndEveryFlippedByteIsRefused) {
    const std::string file = serialized_file({serialized_payload(test::tetrahedron(), 4, false)}, 4);
    const std::size_t mesh_end = file.size() - 12;  // the table is not needed for the first mesh
    for (std::size_t n = 0; n < mesh_end; ++n)
        EXPECT_THROW(parse(file.substr(0, n)), InputError) << n;
    for (std::size_t i = 0; i < mesh_end; ++i) {
        std::string damaged = file;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
        // zlib's checksum sees what the structure does not; the flag for a dictionary and such are its own affair.
        EXPECT_THROW(parse(damaged), InputError) << i;
    }
}

/// Zeros pack by a factor of a thousand: a small file must not cost gigabytes.
TEST(Serialized, MeshesThatPackTooWellAreRefused) {
    std::string payload;
    test::append<std::uint32_t>(payload, 0x1000u);
    payload += std::string("zeros") + '\0';
    test::append<std::uint64_t>(payload, std::uint64_t{100} << 20);
    test::append<std::uint64_t>(payload, 1);
    std::string file = serialized_file({payload}, 4);
    // As many bytes that could hold as much, were they all runs of zeros.
    file.insert(file.size() - 12, std::string(2 << 20, '\0'));
    expect_refused(file, "no mesh packs so well");
}

}  // namespace
}  // namespace treefarm
