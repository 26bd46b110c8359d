// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "coordinator/input/meshes/ply_file.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/mesh_bytes.h"

using namespace treefarm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const Mesh mesh = parse_ply({reinterpret_cast<const char*>(data), size}, "input");
        for (const std::uint32_t index : mesh.indices)
            if (index >= mesh.positions.size()) std::abort();
        for (const Vec3& position : mesh.positions)
            if (!is_finite(position)) std::abort();
        if (mesh.indices.size() % 3 != 0 || (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size()) ||
            (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size()))
            std::abort();
    } catch (const InputError&) {
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    return {
        "ply\nformat ascii 1.0\ncomment c\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "property float u\nproperty float v\nproperty list uchar int extra\nelement face 2\n"
        "property list uchar int vertex_index\nproperty uchar red\nend_header\n"
        "0 0 0 0 0 0\n1 0 0 1 0 2 7 8\n1 1 0 1 1 0\n0 1 0 0 1 0\n0.5 0.25 0 0 0 1 9\n3 0 1 2 255\n5 0 1 4 2 3 0\n",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property ushort r\nproperty ushort g\nproperty ushort b\nelement face 1\nproperty double red\n"
        "property list uchar int vertex_index\nproperty double green\nproperty double blue\nend_header\n"
        "0 0 0 1 2 3\n1 0 0 4 5 6\n1 1 0 65535 0 9\n0.5 3 0 1 2 1 nan\n",
        test::binary_ply(test::tetrahedron(), false), test::binary_ply(test::tetrahedron(), true),
        "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n"};
}
