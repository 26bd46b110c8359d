// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mitsuba_materials.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

class MitsubaBsdfModels : public MitsubaMaterials {};

TEST_F(MitsubaBsdfModels, RoughDiffusePhongAndWard) {
    const auto rough = of_type<RoughDiffuseMaterial>("roughdiffuse");
    EXPECT_EQ(rough.alpha.value, 0.2f);
    EXPECT_FALSE(rough.fast);
    const auto given = of_type<RoughDiffuseMaterial>("roughdiffuse",
                                                     rgb("diffuseReflectance", "0.1 0.2 0.3") + number("alpha", "0.5") +
                                                         "<boolean name=\"useFastApprox\" value=\"true\"/>");
    EXPECT_EQ(given.reflectance.value, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_TRUE(given.fast);

    const auto phong = of_type<PhongMaterial>("phong", board("exponent"));
    EXPECT_EQ(phong.diffuse_reflectance.value, Rgb(0.5f));
    EXPECT_EQ(phong.specular_reflectance.value, Rgb(0.2f));
    EXPECT_TRUE(phong.exponent.varies());

    const auto ward = of_type<WardMaterial>("ward", number("alphaU", "0.05") + word("variant", "ward-duer"));
    EXPECT_EQ(ward.variant, WardVariant::duer);
    EXPECT_EQ(ward.roughness.alpha_u.value, 0.05f);
    EXPECT_EQ(ward.roughness.alpha_v.value, 0.1f);
    EXPECT_EQ(of_type<WardMaterial>("ward").variant, WardVariant::balanced);
    EXPECT_THROW(material(bsdf("ward", word("variant", "new"))), InputError);
    EXPECT_THROW(material(bsdf("phong", number("exponent", "-1"))), InputError);
}

TEST_F(MitsubaBsdfModels, DiffuseTransmitters) {
    EXPECT_EQ(of_type<DiffuseTransmitterMaterial>("difftrans").transmittance.value, Rgb(0.5f));
    const auto given = of_type<DiffuseTransmitterMaterial>("difftrans", rgb("transmittance", "0.1 0.2 0.3"));
    EXPECT_EQ(given.transmittance.value, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_TRUE(of_type<DiffuseTransmitterMaterial>("difftrans", board("transmittance")).transmittance.varies());
    EXPECT_THROW(material(bsdf("difftrans", rgb("transmittance", "-0.1 0.2 0.3"))), InputError);
}

TEST_F(MitsubaBsdfModels, ThinLayers) {
    const auto skin = of_type<ThinLayerMaterial>("hk");
    EXPECT_EQ(skin.scattering.value, Rgb(0.74f, 0.88f, 1.01f) * 100.0f) << "as in Mitsuba 0.6, Skin1";
    EXPECT_EQ(skin.absorption.value, Rgb(0.032f, 0.17f, 0.48f) * 100.0f);
    const std::string milk = "<string name=\"material\" value=\"Regular Milk\"/>";
    EXPECT_NEAR(of_type<ThinLayerMaterial>("hk", milk).scattering.value.x, 100.0f * 18.2052f * 0.25f, 1e-3f);
    EXPECT_NEAR(of_type<ThinLayerMaterial>("hk", milk + "<float name=\"scale\" value=\"0.01\"/>").absorption.value.y,
                0.0046f, 1e-8f);
    EXPECT_EQ(skin.mean_cosine.value, 0.0f);
    const std::string thick = "<float name=\"thickness\" value=\"0.5\"/>";
    const auto given = of_type<ThinLayerMaterial>(
        "hk", thick + rgb("sigmaS", "1 2 3") + rgb("sigmaA", "4 5 6") + "<phase type=\"hg\"/>");
    EXPECT_EQ(given.scattering.value, Rgb(0.5f, 1.0f, 1.5f));
    EXPECT_EQ(given.absorption.value, Rgb(2.0f, 2.5f, 3.0f));
    EXPECT_EQ(given.mean_cosine.value, 0.8f);
    const auto other = of_type<ThinLayerMaterial>("hk", rgb("sigmaT", "4 4 4") + rgb("albedo", "0.25 0.5 0.75"));
    EXPECT_EQ(other.scattering.value, Rgb(1.0f, 2.0f, 3.0f));
    EXPECT_EQ(other.absorption.value, Rgb(3.0f, 2.0f, 1.0f));
    EXPECT_TRUE(of_type<ThinLayerMaterial>("hk", board("sigmaS")).scattering.varies());
    const std::string forward = "<phase type=\"hg\"><float name=\"g\" value=\"1\"/></phase>";
    for (const std::string& bad :
         {milk + rgb("sigmaS", "1 1 1"), milk + rgb("sigmaT", "4 4 4") + rgb("albedo", "1 1 1"),
          rgb("sigmaS", "1 1 1") + rgb("sigmaT", "4 4 4") + rgb("albedo", "1 1 1"), rgb("sigmaT", "4 4 4"),
          rgb("albedo", "1 1 1"), rgb("sigmaS", "-1 0 0"), forward, std::string("<phase type=\"rayleigh\"/>"),
          std::string("<string name=\"material\" value=\"ketchupp\"/>"),
          std::string("<float name=\"thickness\" value=\"-1\"/>")})
        EXPECT_THROW(material(bsdf("hk", bad)), InputError) << bad;
}

TEST_F(MitsubaBsdfModels, DiffuseAndSpecularPartsThatAddUpToMoreThanOneAreScaledDown) {
    const auto loaded = load_with_sensor(
        "<shape type=\"rectangle\">" +
        bsdf("phong", rgb("diffuseReflectance", "0.8 0.5 0.5") + rgb("specularReflectance", "0.8 0.1 0.1")) +
        "</shape>");
    const auto& phong = std::get<PhongMaterial>(loaded.scene.materials.at(0).bsdf);
    EXPECT_FLOAT_EQ(phong.diffuse_reflectance.value.x, 0.5f);
    EXPECT_FLOAT_EQ(phong.specular_reflectance.value.y, 0.0625f);
    EXPECT_TRUE(std::any_of(loaded.warnings.begin(), loaded.warnings.end(), [](const auto& warning) {
        return warning.text().find("add up to 1.6") != std::string::npos;
    }));
}

TEST_F(MitsubaBsdfModels, Coatings) {
    const Scene coated =
        scene(bsdf("roughcoating", number("intIOR", "1.5") + number("extIOR", "1") + number("alpha", "0.2") +
                                       number("thickness", "2") + rgb("sigmaA", "0.1 0.2 0.5") +
                                       bsdf("bumpmap", board("map") + bsdf("diffuse", rgb("reflectance", "0.25")))));
    const Material& material_ = coated.materials.at(static_cast<std::size_t>(coated.shapes.at(0).material));
    const auto& coat = std::get<CoatingMaterial>(material_.bsdf);
    EXPECT_EQ(coat.eta, 1.5f);
    EXPECT_EQ(coat.absorption.value, Rgb(0.2f, 0.4f, 1.0f)) << "optical depth";
    EXPECT_EQ(coat.roughness.alpha_u.value, 0.2f);
    const Material& beneath = coated.materials.at(static_cast<std::size_t>(coat.coated));
    EXPECT_EQ(std::get<DiffuseMaterial>(beneath.bsdf).reflectance.value, Rgb(0.25f));
    EXPECT_TRUE(beneath.detail.any()) << "its bumps are beneath the coat";
    EXPECT_FALSE(material_.detail.any());

    const auto plain = of_type<CoatingMaterial>("coating", bsdf("twosided", bsdf("diffuse")));
    EXPECT_TRUE(plain.roughness.smooth());
    EXPECT_NEAR(plain.eta, 1.5046f / 1.000277f, 1e-6f);
    EXPECT_TRUE(of_type<CoatingMaterial>("coating", board("sigmaA") + bsdf("plastic")).absorption.varies());
    EXPECT_TRUE(material(bsdf("twosided", bsdf("coating", bsdf("plastic")))).twosided);
    for (const std::string& inside :
         {std::string(), bsdf("diffuse") + bsdf("plastic"), number("thickness", "-1") + bsdf("diffuse"),
          rgb("sigmaA", "-1") + bsdf("diffuse"), number("intIOR", "0") + bsdf("diffuse")})
        EXPECT_THROW(material(bsdf("coating", inside)), InputError) << inside;
    EXPECT_THROW(material(bsdf("twosided", bsdf("coating", bsdf("dielectric")))), InputError) << "light passes";
}

TEST_F(MitsubaBsdfModels, ThinPrincipled) {
    const std::string v3 = "3.0.0";
    const auto plain = of_type<PrincipledThinMaterial>("principledthin", "", v3);
    EXPECT_EQ(plain.eta.value, 1.5f);
    EXPECT_FALSE(plain.transmits());
    const auto given =
        of_type<PrincipledThinMaterial>("principledthin",
                                        rgb("base_color", "0.8 0.4 0.2") + board("eta") + number("diff_trans", "2") +
                                            number("diffuse_transmittance_sampling_rate", "2"),
                                        v3);
    EXPECT_TRUE(given.eta.varies() && given.transmits());
    for (const std::string& inside :
         {number("diff_trans", "2.5"), number("eta", "0"), number("spec_trans", "2"), number("shine", "1")})
        EXPECT_THROW(material(bsdf("principledthin", inside), v3), InputError) << inside;
}

TEST_F(MitsubaBsdfModels, Principled) {
    const std::string v3 = "3.0.0";
    const auto plain = of_type<PrincipledMaterial>("principled", "", v3);
    EXPECT_NEAR(plain.eta, 1.5f, 1e-6f) << "a specular of 0.5";
    EXPECT_FALSE(plain.transmits());
    const auto given = of_type<PrincipledMaterial>(
        "principled",
        rgb("base_color", "0.8 0.4 0.2") + number("roughness", "0.2") + board("metallic") +
            number("spec_trans", "0.5") + number("specular", "0") + number("main_specular_sampling_rate", "2"),
        v3);
    EXPECT_EQ(given.base_color.value, Rgb(0.8f, 0.4f, 0.2f));
    EXPECT_TRUE(given.metallic.varies() && given.transmits());
    EXPECT_GT(given.eta, 1.0f) << "where light passes the boundary bends it";
    EXPECT_EQ(of_type<PrincipledMaterial>("principled", number("eta", "1.3"), v3).eta, 1.3f);
    for (const std::string& inside : {number("eta", "1.3") + number("specular", "0.5"), number("specular", "2"),
                                      number("roughness", "1.5"), number("metallic", "-1"), number("shine", "1")})
        EXPECT_THROW(material(bsdf("principled", inside), v3), InputError) << inside;
}

}  // namespace
}  // namespace treefarm
