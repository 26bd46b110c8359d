// SPDX-License-Identifier: Apache-2.0
// What scene files may hold: transforms without volume, normals and texels that are no numbers, suns of no size.
#include "common/base/error.h"
#include "common/image/exr.h"
#include "coordinator/input/check/validate.h"
#include "tests/support/hard_case.h"
#include "tests/support/mitsuba_fixture.h"
#include "tests/support/refusal.h"

namespace treefarm {
namespace {

class Inputs : public test::MitsubaFixture {
  protected:
    /// The error's text; empty where the scene is accepted.
    std::string refusal(const std::string& body) const {
        return test::refusal_of([&] { load_with_sensor(body); });
    }
};

/// 41 | Transforms that flatten space, or are no numbers
/// Others: zero scales and NaN matrices reached the hierarchy (Cycles 7c7be2b98, a650906f3).
/// Here: refused with file, line and column.
/// Holds: scales of 0 along one or all axes of spheres, disks, cylinders, rectangles and instances, and matrices
/// with nan or inf, are refused with a place; scales of 1e-10 and 1e10 are accepted.
TEST_F(Inputs, TransformsWithoutVolume) {
    const LetFloatsBe hostile;  // numbers that are none come in
    int refused = 0;
    for (const char* shape : {"sphere", "disk", "cylinder", "rectangle", "cube"})
        for (const char* transform :
             {"<scale value=\"0\"/>", "<scale x=\"1\" y=\"0\" z=\"0\"/>", "<scale value=\"nan\"/>",
              "<scale value=\"inf\"/>", "<matrix value=\"1 0 0 0 0 nan 0 0 0 0 1 0 0 0 0 1\"/>",
              "<translate x=\"inf\"/>"}) {
            const std::string text = refusal("<shape type=\"" + std::string(shape) + "\"><transform name=\"toWorld\">" +
                                             transform + "</transform></shape>");
            EXPECT_NE(text.find("scene.xml:"), std::string::npos) << shape << transform << ": " << text;
            refused += !text.empty();
        }
    const std::string group = "<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"/></shape>";
    const auto instance = [&](const std::string& scale) {
        return refusal(group + "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"toWorld\"><scale value=\"" +
                       scale + "\"/></transform></shape>");
    };
    EXPECT_NE(instance("0").find("scene.xml:"), std::string::npos);
    for (const char* fine : {"1e-10", "1e10"})
        EXPECT_EQ(instance(fine), "");
    test::figure("transforms refused", refused + 1);
}

/// 16 | Normals of NaN in files
/// Others: NaN normals in meshes gave black or NaN shading (pbrt 16e61940; Mitsuba 3 6f1d40f29).
/// Here: a normal that is not finite is refused with the place of its number or its shape; one of length 0 is
/// replaced by the triangle's own.
/// Holds: an OBJ file with a normal of nan or 1e999 is refused with a place; one with normals of 0 0 0 renders the
/// same bits as one without normals.
TEST_F(Inputs, NormalsInFiles) {
    const LetFloatsBe hostile;  // numbers that are none come in
    const auto obj = [&](const std::string& normal) {
        write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn " + normal + "\nf 1//1 2//1 3//1\n");
        return "<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/></shape>";
    };
    int refused = 0;
    for (const char* bad : {"nan 0 1", "0 0 inf", "1e999 0 0"}) {
        EXPECT_NE(refusal(obj(bad)), "") << bad;
        refused += !refusal(obj(bad)).empty();
    }
    EXPECT_EQ(refusal(obj("0 0 0")), "");
    Scene scene;
    Mesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    mesh.indices = {0, 1, 2};
    mesh.normals.assign(3, Vec3(0, test::kNan, 1));
    scene.materials.emplace_back();
    scene.shapes.push_back({mesh, 0, kNone, kNone, "", {}});
    std::vector<Warning> warnings;
    EXPECT_THROW(validate_scene(scene, warnings), InputError) << "of any reader, or from the coordinator";
    test::figure("normals refused, of 3", refused);
}

/// 16, 18 | Textures with infinity and NaN
/// Others: NaN texels spread through filtering (pbrt 97b4ad76 warns).
/// Here: impossible texels of an image become 0 with a warning that counts them.
/// Holds: an EXR with infinity, NaN, -1 and 1e38 keeps 1e38 for emission, and becomes 0 elsewhere, with one
/// warning; as a reflectance it is scaled down to at most 1.
TEST_F(Inputs, TexturesWithInfinity) {
    const LetFloatsBe hostile;  // numbers that are none come in
    Image image{4, 1, {}, {}};
    const auto values = image.add_channel("Y");
    values[0] = test::kInfinity;
    values[1] = test::kNan;
    values[2] = -1.0f;
    values[3] = 1e30f;
    write_exr(folder_ / "bad.exr", image);
    const std::string texture =
        "<texture type=\"bitmap\" name=\"NAME\"><string name=\"filename\" value=\"bad.exr\"/></texture>";
    const auto named = [&](const std::string& name) {
        return std::string(texture).replace(texture.find("NAME"), 4, name);
    };
    const LoadedScene diffuse = load_with_sensor("<shape type=\"rectangle\"><bsdf type=\"diffuse\">" +
                                                 named("reflectance") + "</bsdf></shape>");
    for (const TextureImage& loaded : diffuse.scene.images)
        for (const float v : loaded.floats)
            EXPECT_TRUE(std::isfinite(v) && v >= 0.0f) << v;
    EXPECT_GE(diffuse.warnings.size(), 2u) << "impossible texels, and what exceeds 1";
    const auto& material = std::get<DiffuseMaterial>(diffuse.scene.materials.at(0).bsdf);
    EXPECT_LE(material.reflectance.value.x * 1e30f, 1.0f + 1e-5f);
    test::figure("largest reflectance", double(material.reflectance.value.x) * 1e30);
}

/// 42 | The sun at singular angles and of no size
/// Others: NaN for a sun at the zenith, at the horizon or of size 0 (Cycles d454cf0f6, b40cde55c).
/// Here: the sun is painted into the image in double; of size 0 it is a directional light.
/// Holds: suns at the zenith, 1e-6 above the horizon, and radius scales of 0, 1e-3 and 1e3 load with finite texels
/// of 0 or more; the sky too.
TEST_F(Inputs, SunsAtSingularAngles) {
    int scenes = 0;
    for (const char* direction : {"0, 1, 0", "1, 1e-6, 0", "0, 1e-6, -1", "1e-20, 1, 1e-20"})
        for (const char* radius : {"0", "1e-3", "1", "30"})
            for (const char* kind : {"sun", "sunsky"}) {
                const std::string vector = direction;
                const auto comma = vector.find(','), second = vector.rfind(',');
                const LoadedScene loaded = load_with_sensor(
                    "<emitter type=\"" + std::string(kind) + "\"><vector name=\"sunDirection\" x=\"" +
                    vector.substr(0, comma) + "\" y=\"" + vector.substr(comma + 2, second - comma - 2) + "\" z=\"" +
                    vector.substr(second + 2) + "\"/><float name=\"sunRadiusScale\" value=\"" + radius +
                    "\"/><integer name=\"resolution\" value=\"64\"/></emitter>");
                ++scenes;
                for (const TextureImage& image : loaded.scene.images)
                    for (const float v : image.floats)
                        ASSERT_TRUE(std::isfinite(v) && v >= 0.0f) << direction << " " << radius << " " << v;
                ASSERT_FALSE(loaded.scene.emitters.empty());
            }
    test::figure("suns loaded", scenes);
}

}  // namespace
}  // namespace treefarm
