// SPDX-License-Identifier: Apache-2.0
// Which way up an image comes out on each kind of shape: as Mitsuba shows it.
#include "common/config/job.h"
#include "tests/support/local_render.h"
#include "tests/support/mesh_bytes.h"
#include "tests/support/mitsuba_fixture.h"
#include "tests/support/tiny_images.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

/// Rows from the top; each value occurs once, so that no turn or mirror image looks the same.
const std::vector<std::uint16_t> kImage = {10, 20, 30, 40, 50, 60, 70, 80, 90};
const std::vector<std::uint16_t> kUpsideDown = {70, 80, 90, 40, 50, 60, 10, 20, 30};

/// The square from (-1, -1, 0) to (1, 1, 0), with u along x and v along y.
Mesh square() {
    Mesh mesh;
    mesh.positions = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
    mesh.normals.assign(4, Vec3(0, 0, 1));
    mesh.uvs = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

class TextureOrientation : public MitsubaFixture {
  protected:
    void SetUp() override {
        MitsubaFixture::SetUp();
        write("f.png", TinyPng{3, 3, 1, 8, kImage, 0.0}.bytes());
        write("m.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
        write("m.ply", binary_ply(square(), false));
        write("m.serialized", serialized_file({serialized_payload(square(), 4, false)}, 4));
    }

    /// A shape that shines with the image, seen from (0, 0, 10) with x to the right and y up: 3 x 3 pixels.
    std::vector<std::uint16_t> seen(const std::string& shape, const std::string& inside, bool is_old) const {
        const std::string decoding =
            is_old ? "<float name=\"gamma\" value=\"1\"/><string name=\"filterType\" value=\"nearest\"/>"
                   : "<boolean name=\"raw\" value=\"true\"/><string name=\"filter_type\" value=\"nearest\"/>";
        const std::string film = sensor(
            std::string("<transform name=\"to_world\"><lookat origin=\"0,0,10\" target=\"0,0,0\" up=\"0,1,0\"/>") +
                "</transform><float name=\"fov\" value=\"11.4211862\"/>",
            3, 3);
        const LoadedScene loaded =
            load(film + "<shape type=\"" + shape + "\">" + inside +
                     "<emitter type=\"area\"><texture type=\"bitmap\" name=\"radiance\">" +
                     "<string name=\"filename\" value=\"f.png\"/>" + decoding + "</texture></emitter></shape>",
                 is_old ? "0.6.0" : "3.0.0");
        Job job;
        job.budget.spp = 4;
        job.guiding.type = GuidingType::none;
        Scene scene = loaded.scene;
        scene.film.filter = PixelFilter::box;
        scene.film.filter_radius = 0.5f;
        std::vector<std::uint16_t> pixels;
        for (const auto& mean : render_locally(scene, job).image.mean)
            pixels.push_back(static_cast<std::uint16_t>(std::lround(mean.x * 255)));
        return pixels;
    }
    std::vector<std::uint16_t> file_seen(const std::string& kind, const std::string& inside, bool is_old) const {
        return seen(kind, "<string name=\"filename\" value=\"m." + kind + "\"/>" + inside, is_old);
    }
};

/// The image's top row is at v = 0 in all versions; only OBJ files are turned (rectangle.cpp, cube.cpp, obj.cpp,
/// ply.cpp, serialized.cpp and bitmap.cpp of Mitsuba 0.6 and 3). Mitsuba 3's own picture of rectangles is its reference
/// test_texture_interp, with which ours agrees.
TEST_F(TextureOrientation, IsMitsubas) {
    for (const bool is_old : {false, true}) {
        EXPECT_EQ(seen("rectangle", "", is_old), kUpsideDown);
        EXPECT_EQ(file_seen("obj", "", is_old), kImage);
        EXPECT_EQ(file_seen("ply", "", is_old), kUpsideDown);
        EXPECT_EQ(file_seen("serialized", "", is_old), kUpsideDown);
        EXPECT_EQ(file_seen("obj", "<boolean name=\"flip_tex_coords\" value=\"false\"/>", is_old), kUpsideDown);
        // On this face of a cube u runs upwards and v to the right.
        EXPECT_EQ(seen("cube", "<transform name=\"to_world\"><translate z=\"-1\"/></transform>", is_old),
                  (std::vector<std::uint16_t>{30, 60, 90, 20, 50, 80, 10, 40, 70}));
    }
}

}  // namespace
}  // namespace treefarm
