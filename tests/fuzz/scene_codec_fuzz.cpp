// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "common/scene/pack/scene_codec.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/every_kind.h"
#include "tests/support/kind_scenes.h"

using namespace treefarm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const Scene scene = decode_scene({data, size});
        // One scene has one byte form, and what was read can be walked.
        if (encode_scene(scene) != Bytes(data, data + size)) std::abort();
        for (const Shape& shape : scene.shapes)
            if (const auto* mesh = std::get_if<Mesh>(&shape.geometry))
                for (const std::uint32_t index : mesh->indices)
                    if (index >= mesh->positions.size()) std::abort();
        scene.bounds();
        scene.radiance_scale();
    } catch (const FormatError&) {
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    const auto text = [](const Scene& scene) {
        const Bytes bytes = encode_scene(scene);
        return std::string(bytes.begin(), bytes.end());
    };
    std::vector<std::string> seeds = {text(Scene{}), text(test::every_kind_scene())};
    for (const Scene& scene : test::kind_scenes())
        seeds.push_back(text(scene));
    return seeds;
}
