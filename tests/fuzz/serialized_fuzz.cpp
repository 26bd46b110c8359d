// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <sstream>

#include "coordinator/input/meshes/serialized_file.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/mesh_bytes.h"

using namespace treefarm;

/// The first byte says what follows: 'f' and an index a file, '3' and '4' what is packed into a file of that version,
/// so that mutations get past zlib's checksum.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2) return 0;
    std::string file(data + 1, data + size);
    std::int64_t index = 0;
    if (data[0] == '3' || data[0] == '4') {
        file = test::serialized_file({file}, data[0] - '0');
    } else {
        index = data[1];
        file.erase(0, 1);
    }
    try {
        std::istringstream in(file);
        const Mesh mesh = parse_serialized(in, file.size(), index, "input");
        for (const std::uint32_t i : mesh.indices)
            if (i >= mesh.positions.size()) std::abort();
        for (const Vec3& position : mesh.positions)
            if (!is_finite(position)) std::abort();
    } catch (const InputError&) {
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    const Mesh mesh = test::tetrahedron();
    const std::string single = test::serialized_payload(mesh, 4, false, true),
                      doubles = test::serialized_payload(mesh, 3, true);
    return {"4" + single, "3" + doubles,
            "f" + std::string(1, '\1') + test::serialized_file({single, test::serialized_payload(mesh, 4, true)}, 4),
            "f" + std::string(1, '\1') + test::serialized_file({doubles, doubles}, 3)};
}
