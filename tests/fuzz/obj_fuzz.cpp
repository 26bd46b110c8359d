// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "coordinator/input/meshes/obj_file.h"
#include "tests/fuzz/fuzz.h"

using namespace treefarm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const ObjFile obj = parse_obj({reinterpret_cast<const char*>(data), size}, "input");
        for (const ObjFile::Corner& corner : obj.corners)
            if (corner.position >= obj.positions.size() ||
                (corner.uv != ObjFile::Corner::kMissing && corner.uv >= obj.uvs.size()) ||
                (corner.normal != ObjFile::Corner::kMissing && corner.normal >= obj.normals.size()))
                std::abort();
    } catch (const InputError&) {
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    return {
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "# all forms\nmtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 1 1e0 0\nv 0 1 -0.5\nv 0.5 0.25 0\nvt 0 0\nvt 1\n"
        "vn 0 0 1\ng part\nusemtl red\ns off\nf 1/1/1 2/2/1 3//1\nf -1 -2/-1 -3/-1/-1 \\\n -4\nf 1 2 5 3 4\nl 1 2\n",
        "v 0 0 0\r\nf 1 1 9\r\n", "f 1 2 3\n"};
}
