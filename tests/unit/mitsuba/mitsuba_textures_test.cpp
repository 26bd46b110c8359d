// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "common/image/exr.h"
#include "tests/support/mitsuba_fixture.h"
#include "tests/support/plain_images.h"
#include "tests/support/tiny_images.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

class MitsubaTextures : public MitsubaFixture {
  protected:
    void SetUp() override {
        MitsubaFixture::SetUp();
        write("rgb.png", TinyPng{2, 1, 3, 8, {0, 128, 255, 255, 0, 64}, 0.0}.bytes());
    }

    static std::string bitmap(const std::string& inside, const std::string& file = "rgb.png",
                              const std::string& name = "reflectance") {
        return "<texture type=\"bitmap\" name=\"" + name + "\"><string name=\"filename\" value=\"" + file + "\"/>" +
               inside + "</texture>";
    }
    static std::string diffuse(const std::string& texture) {
        return "<shape type=\"rectangle\"><bsdf type=\"diffuse\">" + texture +
               "</bsdf></shape><emitter type=\"point\"/>";
    }
    Scene scene(const std::string& inside, const std::string& file = "rgb.png",
                const std::string& version = "0.6.0") const {
        return load_with_sensor(diffuse(bitmap(inside, file)), version).scene;
    }
    static const BitmapTexture& bitmap_of(const Scene& scene) {
        return std::get<BitmapTexture>(scene.textures.at(0).kind);
    }
};

TEST_F(MitsubaTextures, BytesStayBytesWithTheirDecoding) {
    const Scene s = scene("");
    const TextureImage& image = s.images.at(0);
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(image.bytes, (std::vector<std::uint8_t>{0, 128, 255, 255, 0, 64}));
    EXPECT_TRUE(image.floats.empty());
    EXPECT_NEAR(image.decode[128], 0.2158605f, 1e-6f);  // sRGB
    EXPECT_EQ(image.decode[255], 1.0f);
    EXPECT_EQ(std::get<DiffuseMaterial>(s.materials[0].bsdf).reflectance.texture, 0);
    EXPECT_EQ(std::get<DiffuseMaterial>(s.materials[0].bsdf).reflectance.value, Rgb(1.0f));

    const float half = 128.0f / 255.0f;
    EXPECT_NEAR(scene("<float name=\"gamma\" value=\"1\"/>").images[0].decode[128], half, 1e-6f);
    EXPECT_NEAR(scene("<float name=\"gamma\" value=\"2\"/>").images[0].decode[128], half * half, 1e-6f);
    EXPECT_NEAR(scene("<boolean name=\"raw\" value=\"true\"/>", "rgb.png", "3.0.0").images[0].decode[128], half, 1e-6f);
    EXPECT_EQ(scene("<boolean name=\"raw\" value=\"true\"/>").images[0].decode, s.images[0].decode) << "0.6 has no raw";
    EXPECT_THROW(scene("<float name=\"gamma\" value=\"-2\"/>"), InputError);
}

TEST_F(MitsubaTextures, ColoursOfAMesh) {
    write("m.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "property float r\nproperty float g\nproperty float b\nelement face 1\n"
          "property list uchar int vertex_indices\nend_header\n"
          "0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2\n");
    const auto shape = [](const std::string& name) {
        return "<shape type=\"ply\"><string name=\"filename\" value=\"m.ply\"/><bsdf type=\"diffuse\">"
               "<texture type=\"mesh_attribute\" name=\"reflectance\"><string name=\"name\" value=\"" +
               name + "\"/><float name=\"scale\" value=\"0.5\"/></texture></bsdf></shape>";
    };
    const Scene s = load_with_sensor(shape("vertex_color"), "3.0.0").scene;
    EXPECT_EQ(std::get<MeshAttributeTexture>(s.textures.at(0).kind).name, "vertex_color");
    EXPECT_EQ(std::get<DiffuseMaterial>(s.materials[0].bsdf).reflectance, ColorInput(Rgb(0.5f), 0));
    EXPECT_EQ(std::get<Mesh>(s.shapes[0].geometry).attributes.at(0).values,
              (std::vector<Rgb>{Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1)}));
    EXPECT_THROW(load_with_sensor(shape("face_color"), "3.0.0"), InputError);
    try {
        load_with_sensor(shape("color"), "3.0.0");
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("begin its name with vertex_ or face_"), std::string::npos)
            << error.what();
    }
    EXPECT_THROW(load_with_sensor(shape("vertex_color"), "0.6.0"), InputError);

    // In Mitsuba 0.6 the colours are a texture of their own; so are the edges, by default a tenth of their mean length.
    const auto old = [](const std::string& texture) {
        return "<shape type=\"ply\"><string name=\"filename\" value=\"m.ply\"/><bsdf type=\"diffuse\">" + texture +
               "</bsdf></shape>";
    };
    const Scene painted = load_with_sensor(old("<texture type=\"vertexcolors\" name=\"reflectance\"/>")).scene;
    EXPECT_EQ(std::get<MeshAttributeTexture>(painted.textures.at(0).kind).name, "vertex_color");
    EXPECT_EQ(std::get<Mesh>(painted.shapes[0].geometry).attributes.at(0).values.size(), 3u);
    const Scene wires = load_with_sensor(old("<texture type=\"wireframe\" name=\"reflectance\">"
                                             "<rgb name=\"edgeColor\" value=\"0.25\"/></texture>"))
                            .scene;
    const auto& wire = std::get<WireframeTexture>(wires.textures.at(0).kind);
    EXPECT_EQ(wire.edge, Rgb(0.25f));
    EXPECT_NEAR(wire.line_width, 0.1f * (2.0f + std::sqrt(2.0f)) / 3.0f, 1e-6f);
    EXPECT_THROW(load_with_sensor(old("<texture type=\"wireframe\" name=\"reflectance\"/>"), "3.0.0"), InputError);
}

TEST_F(MitsubaTextures, Grids) {
    const Scene s =
        load_with_sensor(diffuse("<texture type=\"gridtexture\" name=\"reflectance\">"
                                 "<rgb name=\"color0\" value=\"0.3\"/><float name=\"lineWidth\" value=\"0.05\"/>"
                                 "<float name=\"uscale\" value=\"10\"/></texture>"))
            .scene;
    const auto& grid = std::get<GridTexture>(s.textures.at(0).kind);
    EXPECT_EQ(grid.color0, Rgb(0.3f));
    EXPECT_EQ(grid.color1, Rgb(0.4f));
    EXPECT_EQ(grid.line_width, 0.05f);
    EXPECT_EQ(grid.uv.u_row, Vec3(10, 0, 0));
    EXPECT_THROW(load_with_sensor(diffuse("<texture type=\"gridtexture\" name=\"reflectance\">"
                                          "<float name=\"lineWidth\" value=\"-1\"/></texture>")),
                 InputError);
}

/// A colour that stands for a number: the mean of its channels in 0.6, its luminance in 2 and 3 and for all heights.
TEST_F(MitsubaTextures, ColouredImagesForNumbers) {
    write("green.png", TinyPng{1, 1, 3, 8, {0, 255, 0}, 0.0}.bytes());
    write("grey.png", TinyPng{1, 1, 3, 8, {99, 99, 99}, 0.0}.bytes());
    const auto mask = [&](const char* file, const char* version) {
        return load_with_sensor("<shape type=\"rectangle\"><bsdf type=\"mask\">" +
                                    bitmap("<boolean name=\"raw\" value=\"true\"/>", file, "opacity") +
                                    "<bsdf type=\"diffuse\"/></bsdf></shape><emitter type=\"constant\"/>",
                                version);
    };
    for (const char* version : {"2.1.0", "3.0.0"}) {
        const LoadedScene loaded = mask("green.png", version);
        EXPECT_EQ(loaded.scene.images.at(0).channels, 1);
        ASSERT_EQ(loaded.scene.images[0].floats.size(), 1u);
        EXPECT_NEAR(loaded.scene.images[0].floats[0], 0.7152f, 1e-4f);
        ASSERT_FALSE(loaded.notes.empty());
        EXPECT_NE(loaded.notes.back().what.find("its luminance counts"), std::string::npos);
        const LoadedScene grey = mask("grey.png", version);
        EXPECT_EQ(grey.scene.images.at(0).bytes.size(), 3u) << "as it was";
        EXPECT_TRUE(grey.notes.empty());
    }
    const LoadedScene old = mask("green.png", "0.6.0");
    EXPECT_EQ(old.scene.images.at(0).bytes, (std::vector<std::uint8_t>{0, 255, 0}));
    EXPECT_NE(old.notes.back().what.find("the mean of its channels counts"), std::string::npos);
    const Scene bump = load_with_sensor(
                           "<shape type=\"rectangle\"><bsdf type=\"bumpmap\"><texture type=\"bitmap\">"
                           "<string name=\"filename\" value=\"green.png\"/><float name=\"gamma\" value=\"1\"/>"
                           "</texture><bsdf type=\"diffuse\"/></bsdf></shape>")
                           .scene;
    EXPECT_NEAR(bump.images.at(0).floats.at(0), 0.7152f, 1e-4f);
}

TEST_F(MitsubaTextures, GammaOfTheFileCountsInTheOldVersion) {
    write("g.png", TinyPng{1, 1, 1, 8, {128}, 0.5}.bytes());
    EXPECT_NEAR(scene("", "g.png").images[0].decode[128], std::pow(128.0f / 255.0f, 2.0f), 1e-5f);
    EXPECT_NEAR(scene("", "g.png", "3.0.0").images[0].decode[128], 0.2158605f, 1e-6f);
}

TEST_F(MitsubaTextures, SixteenBitsAndHdrAndExrBecomeFloats) {
    write("deep.png", TinyPng{1, 1, 1, 16, {32768}, 0.0}.bytes());
    const Scene deep = scene("<float name=\"gamma\" value=\"1\"/>", "deep.png");
    ASSERT_EQ(deep.images[0].floats.size(), 1u);
    EXPECT_NEAR(deep.images[0].floats[0], 32768.0f / 65535.0f, 1e-6f);
    EXPECT_NEAR(scene("", "deep.png").images[0].floats[0], 0.2140505f, 1e-5f);

    write("light.hdr", tiny_hdr({128, 64, 32, 127, 128, 128, 128, 128}));
    const Scene hdr = scene("", "light.hdr");
    EXPECT_EQ(hdr.images[0].floats, (std::vector<float>{0.25f, 0.125f, 0.0625f, 0.5f, 0.5f, 0.5f}));

    Image image{1, 1, {}, {}};
    image.add_channel("Y")[0] = 0.5f;
    image.add_channel("A")[0] = 0.25f;
    write_exr(folder_ / "grey.exr", image);
    EXPECT_EQ(scene("", "grey.exr").images[0].floats, std::vector<float>{0.5f});
    EXPECT_EQ(scene("<string name=\"channel\" value=\"A\"/>", "grey.exr").images[0].floats, std::vector<float>{0.25f});
}

TEST_F(MitsubaTextures, AlphaIsDroppedUnlessAskedFor) {
    write("rgba.png", TinyPng{1, 1, 4, 8, {10, 20, 30, 40}, 0.0}.bytes());
    EXPECT_EQ(scene("", "rgba.png").images[0].bytes, (std::vector<std::uint8_t>{10, 20, 30}));
    const Scene alpha = scene("<string name=\"channel\" value=\"a\"/>", "rgba.png");
    EXPECT_EQ(alpha.images[0].bytes, std::vector<std::uint8_t>{40});
    EXPECT_NEAR(alpha.images[0].decode[40], 40.0f / 255.0f, 1e-6f) << "alpha is never sRGB";
    EXPECT_THROW(scene("<string name=\"channel\" value=\"z\"/>", "rgba.png"), InputError);
}

TEST_F(MitsubaTextures, FiltersAndWraps) {
    EXPECT_TRUE(bitmap_of(scene("")).bilinear);
    EXPECT_FALSE(bitmap_of(scene("<string name=\"filterType\" value=\"nearest\"/>")).bilinear);
    EXPECT_TRUE(bitmap_of(scene("<string name=\"filterType\" value=\"ewa\"/>")).bilinear);
    EXPECT_THROW(scene("<string name=\"filterType\" value=\"soft\"/>"), InputError);
    EXPECT_FALSE(bitmap_of(scene("<string name=\"filter_type\" value=\"nearest\"/>", "rgb.png", "3.0.0")).bilinear);
    const Scene s = scene("<string name=\"wrapMode\" value=\"clamp\"/><string name=\"wrapModeV\" value=\"black\"/>");
    EXPECT_EQ(bitmap_of(s).wrap_u, Wrap::clamp);
    EXPECT_EQ(bitmap_of(s).wrap_v, Wrap::zero);
    EXPECT_THROW(scene("<string name=\"wrapMode\" value=\"around\"/>"), InputError);
}

TEST_F(MitsubaTextures, TransformsOfTheCoordinates) {
    const UvTransform old =
        bitmap_of(scene("<float name=\"uscale\" value=\"2\"/><float name=\"voffset\" value=\"0.5\"/>"
                        "<float name=\"uvscale\" value=\"3\"/>"))
            .uv;
    EXPECT_EQ(old.u_row, Vec3(2, 0, 0));
    EXPECT_EQ(old.v_row, Vec3(0, 3, 0.5f));
    const UvTransform recent =
        bitmap_of(scene("<transform name=\"to_uv\"><scale x=\"2\" y=\"4\"/><rotate z=\"1\" angle=\"90\"/>"
                        "<translate x=\"1\"/></transform>",
                        "rgb.png", "3.0.0"))
            .uv;
    expect_near(recent.u_row, Vec3(0, -4, 1));
    expect_near(recent.v_row, Vec3(2, 0, 0));
}

TEST_F(MitsubaTextures, CheckerboardsAndScales) {
    const auto material = [&](const std::string& texture) { return load_with_sensor(diffuse(texture)).scene; };
    const Scene board = material(
        "<texture type=\"checkerboard\" name=\"reflectance\"><rgb name=\"color1\" value=\"0.1 0.2 0.3\"/>"
        "<float name=\"uscale\" value=\"5\"/></texture>");
    const auto& checkers = std::get<CheckerboardTexture>(board.textures.at(0).kind);
    EXPECT_EQ(checkers.color0, Rgb(0.4f));
    EXPECT_EQ(checkers.color1, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(checkers.uv.u_row, Vec3(5, 0, 0));
    const Scene scaled = material("<texture type=\"scale\" name=\"reflectance\"><float name=\"scale\" value=\"0.5\"/>" +
                                  bitmap("", "rgb.png", "") + "</texture>");
    const ColorInput input = std::get<DiffuseMaterial>(scaled.materials[0].bsdf).reflectance;
    EXPECT_EQ(input.value, Rgb(0.5f));
    EXPECT_EQ(input.texture, 0);
    EXPECT_THROW(material("<texture type=\"scale\" name=\"reflectance\"/>"), InputError);
    EXPECT_THROW(material("<texture type=\"curvature\" name=\"reflectance\"/>"), InputError);
}

TEST_F(MitsubaTextures, FilesAreReadOnceAndOnlyIfUsed) {
    write("broken.png", "no image at all");
    const std::string shared =
        "<texture type=\"bitmap\" id=\"t\"><string name=\"filename\" value=\"rgb.png\"/></texture>";
    const std::string user = "<bsdf type=\"diffuse\"><ref name=\"reflectance\" id=\"t\"/></bsdf>";
    const Scene s = load_with_sensor(shared + "<bsdf type=\"diffuse\" id=\"unused\">" + bitmap("", "broken.png") +
                                     "</bsdf><shape type=\"rectangle\">" + user + "</shape><shape type=\"rectangle\">" +
                                     user + "</shape>" + diffuse(bitmap("")))
                        .scene;
    EXPECT_EQ(s.images.size(), 1u);
    EXPECT_EQ(s.textures.size(), 2u);
    EXPECT_EQ(s.materials.size(), 3u);
    EXPECT_THROW(scene("", "broken.png"), InputError);
    EXPECT_THROW(scene("", "missing.png"), InputError);
    const std::string whole = TinyPng{2, 1, 3, 8, {0, 128, 255, 255, 0, 64}, 0.0}.bytes();
    for (std::size_t length = 0; length + 20 < whole.size(); length += 5) {
        write("cut.png", whole.substr(0, length));
        EXPECT_THROW(scene("", "cut.png"), InputError) << length;
    }
}

TEST_F(MitsubaTextures, ImpossibleValuesBecomeZeroWithAWarning) {
    Image image{2, 1, {}, {}};
    const auto values = image.add_channel("Y");
    values[0] = -1.0f;
    values[1] = std::nanf("");
    write_exr(folder_ / "bad.exr", image);
    const auto loaded = load_with_sensor(diffuse(bitmap("", "bad.exr")));
    EXPECT_EQ(loaded.scene.images[0].floats, (std::vector<float>{0.0f, 0.0f}));
    EXPECT_NE(loaded.warnings.at(0).text().find("2 values"), std::string::npos);
}

/// A reflectance of up to 4 in an image, as the program of the file's version takes it.
TEST_F(MitsubaTextures, ReflectancesAbove1) {
    Image image{2, 1, {}, {}};
    add_rgb_layer(image, "", RgbImage(2, 1, Rgb(0.5f, 4.0f, 1.0f)));
    write_exr(folder_ / "bright.exr", image);
    const auto material = [](const LoadedScene& loaded) { return loaded.scene.materials.at(0); };
    const auto factor = [&](const LoadedScene& loaded) {
        return std::get<DiffuseMaterial>(material(loaded).bsdf).reflectance.value.x;
    };
    const std::string body = diffuse(bitmap("", "bright.exr"));
    const auto warned = [](const LoadedScene& loaded, const std::string& part) {
        return std::any_of(loaded.warnings.begin(), loaded.warnings.end(),
                           [&](const Warning& w) { return w.text().find(part) != std::string::npos; });
    };
    const LoadedScene old = load_with_sensor(body);
    EXPECT_FLOAT_EQ(factor(old), 0.99f / 4.0f) << "BSDF::ensureEnergyConservation";
    EXPECT_FALSE(material(old).unlimited);
    EXPECT_TRUE(warned(old, "reaches 4.000000 in its texture and is scaled down to 0.99"));
    for (const char* version : {"2.0.0", "3.0.0"}) {
        const LoadedScene now = load_with_sensor(body, version);
        EXPECT_EQ(factor(now), 1.0f) << version;
        EXPECT_TRUE(material(now).unlimited) << version;
        EXPECT_TRUE(warned(now, "reaches 4.000000 in its texture: it sends back more light")) << version;
    }
    const LoadedScene asked =
        load_with_sensor("<shape type=\"rectangle\"><bsdf type=\"diffuse\">" + bitmap("", "bright.exr") +
                         "<boolean name=\"ensureEnergyConservation\" value=\"false\"/></bsdf></shape>");
    EXPECT_EQ(factor(asked), 1.0f);
    EXPECT_TRUE(material(asked).unlimited);
    EXPECT_FALSE(warned(asked, "unknown"));

    // Of a mixture there is no more than all: numbers count as 1 wherever they are above, but for old masks.
    const std::string mask = "<shape type=\"rectangle\"><bsdf type=\"mask\">" + bitmap("", "bright.exr", "opacity") +
                             "<bsdf type=\"diffuse\"/></bsdf></shape>";
    EXPECT_FLOAT_EQ(material(load_with_sensor(mask)).opacity.value, 0.99f / 4.0f);
    EXPECT_EQ(material(load_with_sensor(mask, "3.0.0")).opacity.value, 1.0f);
    const std::string blend = "<shape type=\"rectangle\"><bsdf type=\"blendbsdf\">" +
                              bitmap("", "bright.exr", "weight") +
                              "<bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/></bsdf></shape>";
    for (const char* version : {"0.6.0", "3.0.0"})
        EXPECT_EQ(std::get<BlendMaterial>(load_with_sensor(blend, version).scene.materials.at(2).bsdf).weight.value,
                  1.0f)
            << version;
}

/// Two rows, equal in every format, the first row at the top.
TEST_F(MitsubaTextures, FilesOfEveryFormat) {
    write("a.bmp", tiny_bmp());
    write("a.tga", tiny_tga(true));
    write("a.ppm", tiny_ppm());
    write("a.pfm", tiny_pfm());
    const std::vector<std::uint8_t> rows{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    for (const char* version : {"0.6.0", "3.0.0"}) {
        for (const char* file : {"a.bmp", "a.tga", "a.ppm"}) {
            const TextureImage image = scene("", file, version).images.at(0);
            EXPECT_EQ(image.bytes, rows) << file;
            EXPECT_NEAR(image.decode[128], 0.2158605f, 1e-6f) << file << ": sRGB";
        }
        EXPECT_EQ(scene("", "a.pfm", version).images.at(0).floats,
                  (std::vector<float>{3.0f, 4.0f, 5.0f, 0.5f, 1.0f, 2.0f}));
    }
    Image layer{1, 1, {}, {}};
    add_rgb_layer(layer, "beauty", RgbImage(1, 1, Rgb(0.5f, 0.25f, 0.125f)));
    write_exr(folder_ / "layer.exr", layer);
    EXPECT_EQ(scene("", "layer.exr", "3.0.0").images.at(0).floats, (std::vector<float>{0.5f, 0.25f, 0.125f}));
}

}  // namespace
}  // namespace treefarm
