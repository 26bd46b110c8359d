// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "common/scene/model/shape.h"

namespace treefarm::test {

/// Mesh files made in code, for tests of readers.

template <class T>
void append(std::string& bytes, T value, bool big_endian = false) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_endian) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

/// Tetrahedron with unit normals away from its centre, and texture coordinates.
inline Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {Vec3(1, 1, 1), Vec3(-1, -1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1)};
    for (const Vec3& p : mesh.positions)
        mesh.normals.push_back(normalize(p));
    mesh.uvs = {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(0.25f, 0.75f)};
    mesh.indices = {0, 1, 3, 0, 2, 1, 0, 3, 2, 1, 2, 3};
    return mesh;
}

/// Unpacked content of a serialized file.
inline std::string serialized_payload(const Mesh& mesh, int version, bool is_double, bool colors = false) {
    std::string bytes;
    append<std::uint32_t>(bytes, (mesh.normals.empty() ? 0u : 1u) | (mesh.uvs.empty() ? 0u : 2u) | (colors ? 8u : 0u) |
                                     (is_double ? 0x2000u : 0x1000u));
    if (version == 4) bytes += std::string("name") + '\0';
    append<std::uint64_t>(bytes, mesh.positions.size());
    append<std::uint64_t>(bytes, mesh.indices.size() / 3);
    const auto add = [&](const auto& vectors) {
        for (const auto& v : vectors)
            for (unsigned i = 0; i < v.dimensions(); ++i)
                if (is_double)
                    append<double>(bytes, double(v[static_cast<int>(i)]));
                else
                    append<float>(bytes, v[static_cast<int>(i)]);
    };
    add(mesh.positions);
    add(mesh.normals);
    add(mesh.uvs);
    if (colors) add(std::vector<Vec3>(mesh.positions.size(), Vec3(0.5f, -2.0f, 3.0f)));
    for (const std::uint32_t index : mesh.indices)
        append(bytes, index);
    return bytes;
}

/// Serialized file with these contents.
std::string serialized_file(const std::vector<std::string>& payloads, int version);

/// Binary PLY file with normals, texture coordinates, and colours and lists that the reader ignores.
inline std::string binary_ply(const Mesh& mesh, bool big_endian) {
    std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                        "_endian 1.0\ncomment made in code\nelement vertex " + std::to_string(mesh.positions.size()) +
                        "\nproperty uchar red\nproperty double x\nproperty float y\nproperty float z\n"
                        "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n"
                        "element camera 1\nproperty list ushort double view\nproperty short id\n"
                        "element face " +
                        std::to_string(mesh.indices.size() / 3) +
                        "\nproperty list uchar float weights\nproperty list uchar uint vertex_indices\nend_header\n";
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        append<std::uint8_t>(bytes, 200);
        append<double>(bytes, double(mesh.positions[i].x), big_endian);
        for (const float value : {mesh.positions[i].y, mesh.positions[i].z, mesh.normals[i].x, mesh.normals[i].y,
                                  mesh.normals[i].z, mesh.uvs[i].x, mesh.uvs[i].y})
            append(bytes, value, big_endian);
    }
    append<std::uint16_t>(bytes, 2, big_endian);
    append<double>(bytes, 1.5, big_endian);
    append<double>(bytes, 2.5, big_endian);
    append<std::int16_t>(bytes, -7, big_endian);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        append<std::uint8_t>(bytes, 1);
        append<float>(bytes, 0.5f, big_endian);
        append<std::uint8_t>(bytes, 3);
        for (std::size_t k = 0; k < 3; ++k)
            append<std::uint32_t>(bytes, mesh.indices[i + k], big_endian);
    }
    return bytes;
}

}  // namespace treefarm::test
