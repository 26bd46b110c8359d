// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "common/image/exr.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/input/lint/lint.h"
#include "coordinator/input/load.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/xml_seeds.h"
#include "tests/support/mesh_bytes.h"
#include "tests/support/tiny_images.h"

using namespace treefarm;

namespace {

/// A folder with the files that the seeds name; it is removed when the program ends.
class SceneFolder {
  public:
    SceneFolder() : path_(std::filesystem::temp_directory_path() / ("treefarm_fuzz_" + std::to_string(getpid()))) {
        std::filesystem::create_directories(path_);
        write("part.xml", fuzz::kIncludedPart);
        write("t.png", test::TinyPng{2, 2, 3, 8, {1, 50, 100, 150, 200, 250, 30, 60, 90, 120, 180, 240}, 0.0}.bytes());
        write("m.ply", test::binary_ply(test::tetrahedron(), false));
        write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
        write("m.serialized",
              test::serialized_file({test::serialized_payload(test::tetrahedron(), 4, false, true)}, 4));
        write("s.spd", "# nm value\n400 0.2\n550 0.4\n700 0.6\n");
        write("e.hdr", test::tiny_hdr({128, 64, 32, 129, 1, 2, 3, 120}));
        Image image{4, 2, {}, {}};
        add_rgb_layer(image, "", RgbImage(4, 2, Rgb(1.0f, 2.0f, 3.0f)));
        write_exr(path_ / "e.exr", image);
        std::filesystem::create_symlink(scene_.path(), path_ / "scene.xml");
    }
    ~SceneFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    /// A scene file of this text; it lies in memory, beside the others only by name.
    std::filesystem::path write_scene(const std::uint8_t* data, std::size_t size) {
        scene_.assign(data, size);
        return path_ / "scene.xml";
    }

  private:
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
    }

    fuzz::MemoryFile scene_;
    std::filesystem::path path_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static SceneFolder folder;
    const std::filesystem::path file = folder.write_scene(data, size);
    for (const bool lenient : {true, false}) {
        try {
            const Bytes bytes = encode_scene(load_scene(file, {}, lenient).scene);
            if (encode_scene(decode_scene(bytes)) != bytes) std::abort();
        } catch (const InputError&) {
            if (lenient) break;  // what is malformed is so either way
        }
    }
    try {
        for (const Finding& finding : lint(load_scene_to_check(file, {}, true).scene))
            if (finding.text().empty()) std::abort();
    } catch (const InputError&) {
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    return xml_seeds();
}
