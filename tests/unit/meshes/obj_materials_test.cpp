// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "coordinator/input/meshes/mtl_file.h"
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

/// Materials of OBJ files: by BSDFs that are named like them, else by MTL files.
class ObjMaterials : public MitsubaFixture {
  protected:
    void SetUp() override {
        MitsubaFixture::SetUp();
        write("mats.obj",
              "mtllib mats.mtl\nv -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 1 -1 0\nv 1 1 0\n"
              "usemtl red\nf 1 2 3 4\nusemtl blue\nf 2 5 6 3\n");
        write("mats.mtl", "newmtl red\nKd 0.8 0 0\nnewmtl blue\nKd 0 0 0.8\nnewmtl unused\nmap_Kd missing.png\n");
    }

    static std::string obj(const std::string& inside) {
        return "<shape type=\"obj\"><string name=\"filename\" value=\"mats.obj\"/>" + inside + "</shape>";
    }

    static std::string named(const std::string& attributes, const std::string& rgb) {
        return "<bsdf " + attributes + " type=\"diffuse\"><rgb name=\"reflectance\" value=\"" + rgb + "\"/></bsdf>";
    }

    /// The diffuse reflectance left (x < 0) or right of the middle.
    static Rgb reflectance(const Scene& scene, bool left) {
        for (const Shape& shape : scene.shapes) {
            const Box3 box = own_box(shape);
            if (left ? box.max.x < 0.5f : box.min.x > -0.5f) {
                const Material& material = scene.materials.at(static_cast<std::size_t>(shape.material));
                return std::get<DiffuseMaterial>(material.bsdf).reflectance.value;
            }
        }
        ADD_FAILURE() << "no shape there";
        return Rgb(-1.0f);
    }
};

TEST_F(ObjMaterials, BsdfsNamedLikeThem) {
    const std::string by_name = named("name=\"red\"", "0.8,0,0") + named("name=\"blue\"", "0,0,0.7"),
                      by_id = named("id=\"red\"", "0.8,0,0") + named("id=\"blue\"", "0,0,0.7");
    for (const std::string& bsdfs : {by_name, by_id}) {
        const Scene scene = load_with_sensor(obj(bsdfs)).scene;
        ASSERT_EQ(scene.shapes.size(), 2u);
        EXPECT_EQ(reflectance(scene, true), Rgb(0.8f, 0, 0));
        EXPECT_EQ(reflectance(scene, false), Rgb(0, 0, 0.7f));
    }
    const Scene mixed = load_with_sensor(obj(named("name=\"blue\"", "0,0,0.5"))).scene;
    EXPECT_EQ(reflectance(mixed, true), Rgb(0.8f, 0, 0)) << "from the library";
    EXPECT_EQ(reflectance(mixed, false), Rgb(0, 0, 0.5f));
    const Scene common = load_with_sensor(obj(named("name=\"blue\"", "0,0,0.5") + named("", "0.1,0.2,0.3"))).scene;
    EXPECT_EQ(reflectance(common, true), Rgb(0.1f, 0.2f, 0.3f)) << "one without a name is everybody's";
    EXPECT_EQ(load_with_sensor(obj(named("", "0.5"))).scene.shapes.size(), 1u) << "one material, one shape";
    EXPECT_NE(refusal(obj(named("name=\"rad\"", "0.1") + named("name=\"blue\"", "0.1"))).find("did you mean \"red\"?"),
              std::string::npos);
    EXPECT_NE(refusal(obj(by_name), "3.0.0").find("second <bsdf>"), std::string::npos) << "as Mitsuba 3";
}

TEST_F(ObjMaterials, Libraries) {
    const auto loaded = load_with_sensor(obj(""));
    ASSERT_EQ(loaded.scene.shapes.size(), 2u);
    EXPECT_EQ(reflectance(loaded.scene, true), Rgb(0.8f, 0, 0));
    EXPECT_EQ(reflectance(loaded.scene, false), Rgb(0, 0, 0.8f));
    EXPECT_TRUE(loaded.scene.materials.at(0).twosided);

    write("mats.mtl", "newmtl red\nKd 0.2 0 0\nKe 3 2 1\nnewmtl blue\nKd 0.4 0.4 0.4\nKs 0.5 0.5 0.5\nNs 198\n");
    const Scene lit = load_with_sensor(obj("")).scene;
    ASSERT_EQ(lit.emitters.size(), 1u);
    EXPECT_EQ(std::get<AreaEmitter>(lit.emitters[0].kind).radiance.value, Rgb(3, 2, 1));
    const auto blend = std::find_if(lit.materials.begin(), lit.materials.end(),
                                    [](const Material& m) { return std::holds_alternative<BlendMaterial>(m.bsdf); });
    ASSERT_NE(blend, lit.materials.end());
    const auto& parts = std::get<BlendMaterial>(blend->bsdf);
    const auto& base = std::get<DiffuseMaterial>(lit.materials.at(static_cast<std::size_t>(parts.first)).bsdf);
    const auto& mirror = std::get<ConductorMaterial>(lit.materials.at(static_cast<std::size_t>(parts.second)).bsdf);
    EXPECT_NEAR((1.0f - parts.weight.value) * base.reflectance.value.x, 0.4f, 1e-6f);
    EXPECT_NEAR(parts.weight.value * mirror.specular_reflectance.value.x, 0.5f, 1e-6f);
    EXPECT_NEAR(mirror.roughness.alpha_u.value, 0.1f, 1e-6f);

    std::filesystem::remove(folder_ / "mats.mtl");
    const auto grey = load_with_sensor(obj(""));
    ASSERT_EQ(grey.scene.shapes.size(), 1u);
    EXPECT_EQ(std::get<DiffuseMaterial>(grey.scene.materials.at(0).bsdf).reflectance, Rgb(0.5f));
    EXPECT_NE(grey.warnings.at(0).text().find("mats.mtl"), std::string::npos);
}

TEST_F(ObjMaterials, StatementsOfLibraries) {
    const auto one = [](const std::string& text) { return parse_mtl("newmtl a b\n" + text, "m.mtl").at(0); };
    EXPECT_EQ(one("").name, "a b");
    EXPECT_EQ(one("map_Kd -s 1 1 1 -clamp on my map.png").diffuse_map, "my map.png");
    EXPECT_EQ(one("Kd 0.5").diffuse, Rgb(0.5f));
    EXPECT_FALSE(one("Ks 1 1 1\nillum 1").has_specular);
    EXPECT_TRUE(parse_mtl("Kd 1 1 1\n", "m.mtl").empty());
    for (const char* bad : {"Kd", "Kd x", "Ns -1", "Ke nan 0 0", "Kd spectral file.rfl"})
        EXPECT_THROW(one(bad), InputError) << bad;
}

TEST_F(ObjMaterials, AnIndexThatNeverComesDoesNotFollowLater) {
    write("mats.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 9\n");
    EXPECT_NE(refusal(obj("")).find("vertex 9 of 4"), std::string::npos) << refusal(obj(""));
    write("mats.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3 4\nv -1 1 0\n");
    EXPECT_NE(refusal(obj("")).find("only follows later"), std::string::npos) << refusal(obj(""));
}

TEST_F(ObjMaterials, TypesInAnyCaseAndOldVersions) {
    const std::string group =
        "<shape type=\"shapeGroup\" id=\"g\"><shape type=\"sphere\"/></shape>"
        "<shape type=\"instance\"><ref name=\"shapegroup\" id=\"g\"/></shape>";
    EXPECT_EQ(refusal(group), "");
    EXPECT_NE(refusal("<luminaire type=\"constant\"/>", "0.4.4").find("Mitsuba 0.4 or older"), std::string::npos);
}

/// Names hold what stands behind the keyword: "Material #25", several blanks, dashes, numbers.
TEST_F(ObjMaterials, NamesAreTheRestOfTheLine) {
    write("my lib #1.mtl", "newmtl Material #25\nKd 0.8 0 0\nnewmtl Material #26  \nKd 0 0 0.8 # blue\n");
    write("names.obj",
          "mtllib my lib #1.mtl\nv -1 -1 0 # a corner\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 1 -1 0\nv 1 1 0\n"
          "usemtl Material #25\ng left #1\nf 1 2 3 4 # a face\nusemtl Material #26\r\nf 2 5 6 3\n");
    const auto named_obj = [](const std::string& inside) {
        return "<shape type=\"obj\"><string name=\"filename\" value=\"names.obj\"/>" + inside + "</shape>";
    };
    const Scene scene = load_with_sensor(named_obj("")).scene;
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(reflectance(scene, true), Rgb(0.8f, 0, 0));
    EXPECT_EQ(reflectance(scene, false), Rgb(0, 0, 0.8f));
    const Scene by_bsdf = load_with_sensor(named_obj(named("name=\"Material #26\"", "0.5"))).scene;
    EXPECT_EQ(reflectance(by_bsdf, false), Rgb(0.5f));
    // A comment behind a name is no part of it if only so the material is found.
    write("names.obj", "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nusemtl oak  # the seat\nf 1 2 3\n");
    EXPECT_EQ(reflectance(load_with_sensor(named_obj(named("name=\"oak\"", "0.25"))).scene, true), Rgb(0.25f));
}

TEST(Mtl, MapsMayHaveOptionsAndAnyName) {
    const auto map = [](const std::string& line) {
        return parse_mtl("newmtl m\nmap_Kd " + line + "\n", "m.mtl").at(0).diffuse_map;
    };
    EXPECT_EQ(map("two  spaces.png"), "two  spaces.png");
    EXPECT_EQ(map("-weird.png"), "-weird.png");
    EXPECT_EQ(map("Wood #3.png\r"), "Wood #3.png");
    EXPECT_EQ(map("-s 1 1 1 01 wood.png"), "01 wood.png");
    EXPECT_EQ(map("-clamp on -bm 0.5 -weird.png"), "-weird.png");
    EXPECT_EQ(map("-blendu off -imfchan r -o 0.5 wood.png"), "wood.png");
    EXPECT_EQ(map("long \\\nname.png"), "long name.png");
}

}  // namespace
}  // namespace treefarm
