// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "common/config/job_reader.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/input/load.h"
#include "coordinator/input/meshes/obj_file.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

/// Damages a text in one of the ways in which files go wrong. The same seed damages it the same way.
std::string mutate(std::string text, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return n == 0 ? std::size_t{0} : random() % n; };
    static const std::string snippets[] = {
        "nan", "inf", "-1",   "0",     "1e999",           "-",     "\"", "<", ">", "/",
        "&",   "$x",  "\x01", "99999", "<ref id=\"a\"/>", "1 2 3", ":",  ",", "\n"};
    const int count = 1 + static_cast<int>(below(3));
    for (int i = 0; i < count; ++i) {
        const std::size_t at = below(text.size()), length = below(12);
        switch (below(5)) {
            case 0:
                text.erase(at, length);
                break;
            case 1:
                text.insert(at, snippets[below(std::size(snippets))]);
                break;
            case 2:
                text.replace(at, std::min(length, text.size() - at), snippets[below(std::size(snippets))]);
                break;
            case 3:
                text.insert(below(text.size()), text.substr(at, 40 * length));
                break;
            default:
                text.resize(at);
                break;
        }
        if (text.empty()) break;
    }
    return text;
}

/// Whatever is done to a file: it is read, or one line says what is wrong. Anything else is a crash, a hang, or another
/// kind of exception, all of which fail the test.
template <class Read>
void expect_read_or_refused(const std::string& original, const std::filesystem::path& path, int rounds, Read read) {
    std::mt19937 random(20240611);
    int refused = 0;
    for (int round = 0; round < rounds; ++round) {
        const std::string damaged = mutate(original, random);
        std::ofstream(path, std::ios::binary) << damaged;
        try {
            read(path);
        } catch (const InputError& error) {
            ++refused;
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        } catch (const std::exception& error) {
            ADD_FAILURE() << "round " << round << ": " << error.what() << "\n" << damaged;
        }
    }
    EXPECT_GT(refused, rounds / 10) << "the damage does not bite";
    EXPECT_LT(refused, rounds) << "everything is refused";
}

TEST(SceneMutation, Scenes) {
    for (const char* name : {"cornell-box.xml", "door-ajar.xml", "white-furnace.xml"})
        expect_read_or_refused(test::read_file(test::own_scene(name)), test::test_folder() / name, 250,
                               [](const std::filesystem::path& path) {
                                   for (const bool lenient : {true, false}) {
                                       const Bytes bytes = encode_scene(load_scene(path, {}, lenient).scene);
                                       EXPECT_EQ(encode_scene(decode_scene(bytes)), bytes);
                                   }
                               });
}

TEST(SceneMutation, Meshes) {
    std::string obj = "# a mesh\nmtllib a.mtl\no thing\n";
    for (int i = 0; i < 12; ++i) {
        obj +=
            "v " + std::to_string(i) + ".25 " + std::to_string(i * i) + "e-2 -0.5\nvt 0." + std::to_string(i) + " 1\n";
        obj += "vn 0 " + std::to_string(i) + " 1\n";
    }
    obj +=
        "g part\nusemtl red\nf 1 2 3\nf 1/2 3/4 5/6\nf 7//8 9//10 11//12\nf -1/-2/-3 -4/-5/-6 -7/-8/-9 -10/-11/-12\n";
    obj += "f 1 2 3 4 5 6 7 \\\n 8 9 10\n";
    expect_read_or_refused(obj, test::test_folder() / "m.obj", 1000, [](const std::filesystem::path& path) {
        const ObjFile file = read_obj(path, {});
        for (const ObjFile::Corner& corner : file.corners) {
            EXPECT_LT(corner.position, file.positions.size());
            EXPECT_TRUE(corner.uv == ObjFile::Corner::kMissing || corner.uv < file.uvs.size());
            EXPECT_TRUE(corner.normal == ObjFile::Corner::kMissing || corner.normal < file.normals.size());
        }
    });
}

TEST(SceneMutation, Jobs) {
    expect_read_or_refused(write_job(Job{}), test::test_folder() / "job.toml", 1000,
                           [](const std::filesystem::path& path) {
                               const std::string text = write_job(read_job_file(path));
                               Job back;
                               apply_layer(back, parse_job_settings(text, "job.toml"));
                               EXPECT_EQ(write_job(back), text);
                           });
}

}  // namespace
}  // namespace treefarm
