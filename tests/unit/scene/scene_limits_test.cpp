// SPDX-License-Identifier: Apache-2.0
// What a scene of somebody else may read and take.
#include "coordinator/input/check/scene_limits.h"

#include <gtest/gtest.h>

#include "common/image/png.h"
#include "coordinator/input/load.h"
#include "tests/support/refusal.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

class Limits : public test::FolderTest {
  protected:
    void SetUp() override {
        fs::create_directories(folder_ / "root");
        fs::create_directories(folder_ / "outside");
    }

    fs::path scene_with(const std::string& content) const {
        write("root/scene.xml", "<scene version='0.6.0'><sensor type='perspective'/>" + content + "</scene>");
        return folder_ / "root" / "scene.xml";
    }

    SceneLimits below_root() const { return {.root = folder_ / "root"}; }

    /// The message of a scene that is refused; "" for one that is read.
    static std::string refusal(const fs::path& scene, const SceneLimits& limits) {
        return test::refusal_of([&] { load_scene(scene, {}, false, 0, 0, "", limits); });
    }
};

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string mesh(const std::string& file) {
    return "<shape type='obj'><string name='filename' value='" + file + "'/></shape>";
}

TEST_F(Limits, ASceneReadsBelowItsRootOnly) {
    write("root/a.obj", kTriangle);
    write("outside/a.obj", kTriangle);
    write("outside/secret.xml", "<scene version='0.6.0'><shape type='sphere'/></scene>");
    fs::create_symlink(folder_ / "outside" / "a.obj", folder_ / "root" / "link.obj");
    fs::create_directory_symlink(folder_ / "outside", folder_ / "root" / "folder");
    EXPECT_EQ(refusal(scene_with(mesh("a.obj")), below_root()), "");
    EXPECT_EQ(refusal(scene_with(mesh("../root/a.obj")), below_root()), "");
    const std::string outside[] = {
        mesh("../outside/a.obj"),
        mesh((folder_ / "outside" / "a.obj").string()),
        mesh("link.obj"),
        mesh("folder/a.obj"),
        mesh("../outside/missing.obj"),
        "<include filename='../outside/secret.xml'/>",
        "<include filename='/etc/passwd'/>",
        "<shape type='sphere'><bsdf type='diffuse'><spectrum name='reflectance' "
        "filename='/etc/passwd'/></bsdf></shape>",
        "<shape type='sphere'><bsdf type='diffuse'><texture name='reflectance' type='bitmap'><string name='filename' "
        "value='/etc/passwd'/></texture></bsdf></shape>",
    };
    for (const std::string& content : outside) {
        const std::string why = refusal(scene_with(content), below_root());
        EXPECT_NE(why.find("does not lie below scene.root"), std::string::npos) << content << ": " << why;
        EXPECT_EQ(why.find("root:x"), std::string::npos) << "a file's content is told";
    }
    EXPECT_EQ(refusal(scene_with(mesh("link.obj")), {}), "") << "without a root it may read what it names";
}

TEST_F(Limits, NorIsTheSceneItselfReadOutside) {
    fs::rename(scene_with(""), folder_ / "outside" / "scene.xml");
    EXPECT_NE(refusal(folder_ / "outside" / "scene.xml", below_root()).find("scene.root"), std::string::npos);
    EXPECT_NE(refusal(scene_with(""), {.root = folder_ / "missing"}).find("scene.root"), std::string::npos);
}

TEST_F(Limits, NamesInMaterialLibrariesAreHeldAgainstItToo) {
    write("outside/b.mtl", "newmtl red\nKd 1 0 0\n");
    write("root/c.mtl", "newmtl red\nKd 1 1 1\nmap_Kd ../outside/p.png\n");
    write_png(folder_ / "outside" / "p.png", RgbImage(2, 2));
    write("root/b.obj", std::string("mtllib ../outside/b.mtl\nusemtl red\n") + kTriangle);
    write("root/c.obj", std::string("mtllib c.mtl\nvt 0 0\nusemtl red\n") + kTriangle);
    for (const char* file : {"b.obj", "c.obj"}) {
        const std::string why = refusal(scene_with(mesh(file)), below_root());
        EXPECT_NE(why.find("does not lie below scene.root"), std::string::npos) << file << ": " << why;
    }
}

TEST_F(Limits, LargeFilesImagesAndMeshesAreRefusedByName) {
    write("root/a.obj", kTriangle);
    const fs::path scene = scene_with(mesh("a.obj") + mesh("a.obj"));
    EXPECT_EQ(refusal(scene, {.file_bytes = 1000, .triangles = 2}), "");
    EXPECT_NE(refusal(scene, {.file_bytes = 20}).find("of scene.max_file_mb"), std::string::npos);
    EXPECT_NE(refusal(scene, {.triangles = 1}).find("more than the 1 of scene.max_triangles"), std::string::npos);
    write_png(folder_ / "root" / "p.png", RgbImage(20, 10));
    const fs::path textured = scene_with(
        "<shape type='sphere'><bsdf type='diffuse'><texture name='reflectance' type='bitmap'><string name='filename' "
        "value='p.png'/></texture></bsdf></shape>");
    EXPECT_EQ(refusal(textured, {.image_pixels = 200}), "");
    EXPECT_NE(refusal(textured, {.image_pixels = 199}).find("claims 20 x 10 pixels"), std::string::npos);
}

TEST_F(Limits, AreThoseOfTheJob) {
    Job::SceneSource source;
    EXPECT_EQ(scene_limits(source).triangles, ~0ull);
    source.root = "/scenes";
    source.max_file_mb = 3;
    source.max_triangles = 7;
    EXPECT_EQ(scene_limits(source).root, "/scenes");
    EXPECT_EQ(scene_limits(source).file_bytes, 3'000'000u);
    EXPECT_EQ(scene_limits(source).triangles, 7u);
}

}  // namespace
}  // namespace treefarm
