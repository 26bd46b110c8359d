// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mitsuba_materials.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

TEST_F(MitsubaMaterials, MaterialsAndReferences) {
    const auto loaded = load_with_sensor(
        "<bsdf type=\"twosided\" id=\"both\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.1 0.2 "
        "0.3\"/></bsdf></bsdf>"
        "<bsdf type=\"twosided\" id=\"of ref\"><ref id=\"one\"/></bsdf>"
        "<bsdf type=\"diffuse\" id=\"one\"/><alias id=\"one\" as=\"uno\"/>"
        "<shape type=\"rectangle\"><ref id=\"both\"/></shape>"
        "<shape type=\"rectangle\"><ref name=\"bsdf\" id=\"uno\"/></shape>"
        "<shape type=\"rectangle\"><ref id=\"of ref\"/></shape>"
        "<shape type=\"rectangle\"/>"
        "<shape type=\"rectangle\"><emitter type=\"area\"><spectrum name=\"radiance\" value=\"3\"/></emitter></shape>"
        "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"4\"/></emitter>");
    const Scene& scene = loaded.scene;
    const auto material = [&](std::size_t shape) {
        return scene.materials.at(static_cast<std::size_t>(scene.shapes[shape].material));
    };
    const auto reflectance = [&](std::size_t shape) {
        return std::get<DiffuseMaterial>(material(shape).bsdf).reflectance;
    };
    EXPECT_TRUE(material(0).twosided);
    EXPECT_EQ(material(0).name, "both");
    EXPECT_EQ(reflectance(0), Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_FALSE(material(1).twosided);
    EXPECT_EQ(material(1).name, "one");
    EXPECT_TRUE(material(2).twosided);
    EXPECT_EQ(reflectance(2), Rgb(0.5f));
    EXPECT_EQ(reflectance(3), Rgb(0.5f));
    EXPECT_EQ(reflectance(4), Rgb(0.0f)) << "an emitter without a BSDF is black";
    EXPECT_EQ(scene.shapes[4].emitter, 0);
    EXPECT_EQ(std::get<AreaEmitter>(scene.emitters[0].kind).shape, 4);
    EXPECT_EQ(std::get<AreaEmitter>(scene.emitters[0].kind).radiance, Rgb(3.0f));
    EXPECT_EQ(scene.environment(), 1);
}

TEST_F(MitsubaMaterials, ConductorsInBothDialects) {
    // Bitterli's converted scenes, spaceship and kitchen among them, spell out the same numbers for aluminium.
    const auto aluminium = of_type<ConductorMaterial>("conductor", word("material", "Al"), "3.0.0");
    expect_near(aluminium.eta, Rgb(1.65746f, 0.880369f, 0.521229f), 1e-4f);
    expect_near(aluminium.k, Rgb(9.22387f, 6.26952f, 4.837f), 1e-4f);
    EXPECT_TRUE(aluminium.roughness.smooth());
    const auto copper = of_type<ConductorMaterial>("roughconductor");
    expect_near(copper.eta * 1.000277f, of_type<ConductorMaterial>("conductor", word("material", "Cu"), "3.0.0").eta);
    EXPECT_EQ(copper.roughness.distribution, Microfacets::beckmann);
    EXPECT_EQ(copper.roughness.alpha_u, FloatInput(0.1f));
    const auto mirror = of_type<ConductorMaterial>("conductor", "", "3.0.0");
    EXPECT_EQ(mirror.eta, Rgb(0.0f)) << "version 3 has no copper by default";
    EXPECT_EQ(mirror.k, Rgb(1.0f));
    EXPECT_EQ(of_type<ConductorMaterial>("conductor", word("material", "none")).k, Rgb(1.0f));
    const auto given = of_type<ConductorMaterial>(
        "roughconductor", number("extEta", "2") + rgb("eta", "2 4 6") + rgb("k", "8") + number("alphaU", "0.2") +
                              number("alphaV", "0.4") + word("distribution", "GGX") +
                              rgb("specularReflectance", "0.5"));
    EXPECT_EQ(given.eta, Rgb(1, 2, 3));
    EXPECT_EQ(given.k, Rgb(4.0f));
    EXPECT_EQ(given.roughness.distribution, Microfacets::ggx);
    EXPECT_EQ(given.roughness.alpha_u, FloatInput(0.2f));
    EXPECT_EQ(given.roughness.alpha_v, FloatInput(0.4f));
    EXPECT_EQ(given.specular_reflectance.value, Rgb(0.5f));

    const auto refused = [&](const std::string& inside, const char* version = "0.6.0") {
        EXPECT_THROW(material(bsdf("roughconductor", inside), version), InputError) << inside;
    };
    refused(word("material", "Unobtainium"));
    refused(word("distribution", "phong"));
    refused(word("distribution", "smooth"));
    refused(number("alphaU", "0.1"));
    refused(number("alpha", "0.1") + number("alphaU", "0.1") + number("alphaV", "0.1"));
    refused(number("alpha", "-0.1"));
    EXPECT_EQ(of_type<ConductorMaterial>("roughconductor", number("extEta", "1") + rgb("k", "-1 2 3")).k, Rgb(1, 2, 3))
        << "only squares count";
    refused(word("material", "Au") + rgb("eta", "1"), "3.0.0");
    refused(number("roughness", "0.1"), "3.0.0");
}

TEST_F(MitsubaMaterials, DielectricsInBothDialects) {
    EXPECT_NEAR(of_type<DielectricMaterial>("dielectric").eta, 1.5046 / 1.000277, 1e-6);
    EXPECT_NEAR(of_type<ThinDielectricMaterial>("thindielectric", "", "3.0.0").eta, 1.5046 / 1.000277, 1e-6);
    const auto water = of_type<DielectricMaterial>(
        "roughdielectric", word("int_ior", "Water") + number("ext_ior", "2") + rgb("specular_transmittance", "0.25"),
        "3.0.0");
    EXPECT_NEAR(water.eta, 1.333 / 2, 1e-6);
    EXPECT_EQ(water.specular_transmittance.value, Rgb(0.25f));
    EXPECT_FALSE(water.roughness.smooth());
    for (const std::string& inside :
         {word("intIOR", "vater"), number("intIOR", "0"), number("extIOR", "1e9"), rgb("specularTransmittance", "-2")})
        EXPECT_THROW(material(bsdf("dielectric", inside)), InputError) << inside;
}

TEST_F(MitsubaMaterials, PlasticsInBothDialects) {
    const auto smooth = of_type<PlasticMaterial>("plastic");
    EXPECT_NEAR(smooth.eta, 1.49 / 1.000277, 1e-6);
    EXPECT_EQ(smooth.diffuse_reflectance.value, Rgb(0.5f));
    EXPECT_FALSE(smooth.nonlinear);
    EXPECT_TRUE(smooth.roughness.smooth());
    const auto rough = of_type<PlasticMaterial>(
        "roughplastic", "<boolean name=\"nonlinear\" value=\"true\"/>" + board("alpha") + board("diffuse_reflectance"),
        "3.0.0");
    EXPECT_TRUE(rough.nonlinear);
    EXPECT_TRUE(rough.single_return);
    EXPECT_FALSE(of_type<PlasticMaterial>("roughplastic").single_return);
    EXPECT_TRUE(rough.roughness.alpha_u.varies());
    EXPECT_TRUE(rough.diffuse_reflectance.varies());
    EXPECT_THROW(material(bsdf("roughplastic", number("alphaU", "0.1") + number("alphaV", "0.2")), "3.0.0"),
                 InputError);
}

TEST_F(MitsubaMaterials, ModifiersFlattenInAnyOrder) {
    const std::string bump = board("map"), core = bsdf("diffuse", rgb("reflectance", "0.25"));
    for (const std::string& nested :
         {bsdf("mask", number("opacity", "0.5") + bsdf("twosided", bsdf("bumpmap", bump + core))),
          bsdf("bumpmap", bump + bsdf("mask", number("opacity", "0.5") + bsdf("twosided", core))),
          bsdf("twosided", bsdf("bumpmap", bump + bsdf("mask", rgb("opacity", "0.5") + core)))}) {
        const Material m = material(nested);
        EXPECT_TRUE(m.twosided);
        EXPECT_EQ(m.opacity, FloatInput(0.5f));
        EXPECT_EQ(m.detail.bump, 0);
        EXPECT_EQ(m.detail.bump_scale, 1.0f);
        EXPECT_EQ(std::get<DiffuseMaterial>(m.bsdf).reflectance, Rgb(0.25f));
    }
    const Material product = material(bsdf("mask", number("opacity", "0.5") + bsdf("mask", board("opacity") + core)));
    EXPECT_EQ(product.opacity, FloatInput(0.5f, 0));
    EXPECT_EQ(material(bsdf("mask", core)).opacity, FloatInput(0.5f));
    EXPECT_EQ(material(bsdf("bumpmap", number("scale", "3") + bump + core), "3.0.0").detail.bump_scale, 3.0f);
    EXPECT_EQ(material(bsdf("bumpmap", "<texture type=\"scale\">" + number("scale", "4") + bump + "</texture>" + core))
                  .detail.bump_scale,
              4.0f);

    for (const std::string& nested :
         {bsdf("bumpmap", bump + bsdf("bumpmap", bump + core)), bsdf("bumpmap", core), bsdf("bumpmap", bump),
          bsdf("mask", number("opacity", "1.5") + core), bsdf("mask", ""), bsdf("twosided", ""),
          bsdf("twosided", bsdf("dielectric")), bsdf("twosided", core + core + core),
          bsdf("mask", board("opacity") + bsdf("mask", board("opacity") + core))})
        EXPECT_THROW(material(nested), InputError) << nested;
}

TEST_F(MitsubaMaterials, NormalMapsOfAnyTexture) {
    const std::string core = bsdf("diffuse", rgb("reflectance", "0.25"));
    const Material plain = material(bsdf("normalmap", board("normalmap") + core));
    EXPECT_EQ(plain.detail.normal_map, 0);
    EXPECT_EQ(plain.detail.normal_scale, Rgb(1.0f));
    EXPECT_FALSE(plain.detail.flip_invalid || plain.detail.shadowed) << "0.6 does neither";
    const Material scaled = material(bsdf(
        "normalmap", "<texture type=\"scale\">" + number("scale", "0.5") + board("normalmap") + "</texture>" + core));
    EXPECT_EQ(scaled.detail.normal_map, 0);
    EXPECT_EQ(scaled.detail.normal_scale, Rgb(0.5f));
    // Mitsuba 3's own defaults, and what a file may say.
    for (const char* kind : {"normalmap", "bumpmap"}) {
        const Material defaults = material(bsdf(kind, board("normalmap") + core), "3.0.0");
        EXPECT_TRUE(defaults.detail.flip_invalid && defaults.detail.shadowed);
        const auto off = [](const char* name) {
            return std::string("<boolean name=\"") + name + "\" value=\"false\"/>";
        };
        const Material old = material(
            bsdf(kind, off("flip_invalid_normals") + off("use_shadowing_function") + board("normalmap") + core),
            "3.0.0");
        EXPECT_FALSE(old.detail.flip_invalid || old.detail.shadowed);
    }
    const Scene constant = scene(bsdf("normalmap", "<texture type=\"srgb\" name=\"normalmap\">" +
                                                       rgb("color", "0.75,0.5,0.9") + "</texture>" + core),
                                 "3.0.0");
    const NormalDetail& detail = constant.materials.at(static_cast<std::size_t>(constant.shapes[0].material)).detail;
    ASSERT_NE(detail.normal_map, kNone);
    EXPECT_EQ(detail.normal_scale, Rgb(0.75f, 0.5f, 0.9f));
}

TEST_F(MitsubaMaterials, SidesThatDiffer) {
    const Scene s = scene(bsdf("twosided", bsdf("diffuse", rgb("reflectance", "0.25")) + bsdf("plastic")));
    const Material& front = s.materials.at(static_cast<std::size_t>(s.shapes[0].material));
    EXPECT_TRUE(front.twosided);
    EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(front.bsdf));
    ASSERT_LT(front.back, s.shapes[0].material);
    EXPECT_TRUE(std::holds_alternative<PlasticMaterial>(s.materials.at(static_cast<std::size_t>(front.back)).bsdf));
    EXPECT_THROW(material(bsdf("twosided", bsdf("diffuse") + bsdf("dielectric"))), InputError);
    EXPECT_THROW(material(bsdf("twosided", bsdf("diffuse") + bsdf("bumpmap", board("map") + bsdf("diffuse")))),
                 InputError);
}

TEST_F(MitsubaMaterials, BlendsAndMixtures) {
    const auto part = [](const Scene& s, std::int32_t index) {
        return s.materials.at(static_cast<std::size_t>(index));
    };
    const Scene s = scene(bsdf("blendbsdf", board("weight") + bsdf("diffuse") + bsdf("plastic")));
    const auto blend = std::get<BlendMaterial>(part(s, s.shapes[0].material).bsdf);
    EXPECT_TRUE(blend.weight.varies());
    EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(part(s, blend.first).bsdf));
    EXPECT_TRUE(std::holds_alternative<PlasticMaterial>(part(s, blend.second).bsdf));

    const Scene both = scene(bsdf(
        "blendbsdf", number("weight", "0.25") + bsdf("twosided", bsdf("diffuse")) + bsdf("twosided", bsdf("plastic"))));
    EXPECT_TRUE(part(both, both.shapes[0].material).twosided);

    // A mask inside a blend is a blend with nothing.
    const Scene masked =
        scene(bsdf("blendbsdf", number("weight", "0.25") + bsdf("diffuse") + bsdf("mask", bsdf("plastic"))));
    const auto outer = std::get<BlendMaterial>(part(masked, masked.shapes[0].material).bsdf);
    const auto inner = std::get<BlendMaterial>(part(masked, outer.second).bsdf);
    EXPECT_EQ(inner.weight, FloatInput(0.5f));
    EXPECT_TRUE(std::holds_alternative<NullMaterial>(part(masked, inner.first).bsdf));
    EXPECT_TRUE(std::holds_alternative<PlasticMaterial>(part(masked, inner.second).bsdf));

    // The share of each BSDF of a mixture: what is missing to 1 is black.
    const Scene mixed = scene(bsdf(
        "mixturebsdf", word("weights", "0.2, 0.3, 0.1") + bsdf("diffuse", rgb("reflectance", "0.1")) +
                           bsdf("diffuse", rgb("reflectance", "0.2")) + bsdf("diffuse", rgb("reflectance", "0.3"))));
    std::map<float, float> fractions;
    const auto collect = [&](const auto& self, std::int32_t index, float fraction) -> void {
        const Material m = part(mixed, index);
        if (const auto* b = std::get_if<BlendMaterial>(&m.bsdf)) {
            self(self, b->first, fraction * (1 - b->weight.value));
            self(self, b->second, fraction * b->weight.value);
        } else {
            fractions[std::get<DiffuseMaterial>(m.bsdf).reflectance.value.x] += fraction;
        }
    };
    collect(collect, mixed.shapes[0].material, 1.0f);
    EXPECT_NEAR(fractions[0.1f], 0.2f, 1e-6f);
    EXPECT_NEAR(fractions[0.2f], 0.3f, 1e-6f);
    EXPECT_NEAR(fractions[0.3f], 0.1f, 1e-6f);
    EXPECT_NEAR(fractions[0.0f], 0.4f, 1e-6f);

    const std::string bumped = bsdf("bumpmap", board("map") + bsdf("diffuse"));
    const Scene half = scene(bsdf("blendbsdf", bumped + bsdf("plastic")));
    const Material& mixed_bumps = part(half, half.shapes[0].material);
    EXPECT_FALSE(mixed_bumps.detail.any());
    EXPECT_TRUE(part(half, std::get<BlendMaterial>(mixed_bumps.bsdf).first).detail.any());
    for (const std::string& nested : {bsdf("blendbsdf", bsdf("diffuse")),
                                      bsdf("blendbsdf", number("weight", "2") + bsdf("diffuse") + bsdf("plastic")),
                                      bsdf("blendbsdf", bsdf("twosided", bsdf("diffuse")) + bsdf("plastic")),
                                      bsdf("mixturebsdf", word("weights", "0.5") + bsdf("diffuse") + bsdf("plastic")),
                                      bsdf("mixturebsdf", word("weights", "0, 0") + bsdf("diffuse") + bsdf("plastic"))})
        EXPECT_THROW(material(nested), InputError) << nested;
}

TEST_F(MitsubaMaterials, BlendsOfReferencesDoNotExplode) {
    std::string chain = "<bsdf type=\"diffuse\" id=\"0\"/>";
    for (int i = 1; i < 60; ++i) {
        const std::string below = "<ref id=\"" + std::to_string(i - 1) + "\"/>";
        chain += "<bsdf type=\"blendbsdf\" id=\"" + std::to_string(i) + "\">" + below + below + "</bsdf>";
    }
    const std::string last = "<shape type=\"rectangle\"><ref id=\"59\"/></shape>";
    EXPECT_THROW(load_with_sensor(chain + last), InputError);
    std::string nested = "<bsdf type=\"diffuse\" id=\"0\"/>";
    for (int i = 1; i < 60; ++i) {
        const std::string below = "<ref id=\"" + std::to_string(i - 1) + "\"/>";
        nested += "<bsdf type=\"twosided\" id=\"" + std::to_string(i) + "\">" + below + below + "</bsdf>";
    }
    EXPECT_EQ(load_with_sensor(nested + last).scene.materials.size(), 1u);
}

TEST_F(MitsubaMaterials, UnknownPropertiesOfEveryBsdfAreRefused) {
    for (const char* type : {"diffuse", "conductor", "roughconductor", "dielectric", "thindielectric",
                             "roughdielectric", "plastic", "roughplastic", "null"})
        for (const char* version : {"0.6.0", "3.0.0"}) {
            EXPECT_NO_THROW(material(bsdf(type), version)) << type;
            if (version[0] == '0')
                EXPECT_NO_THROW(material(bsdf(type, number("colour", "1")), version)) << type << ": a warning";
            else
                EXPECT_THROW(material(bsdf(type, number("colour", "1")), version), InputError) << type;
            EXPECT_THROW(material(bsdf(type, board("colour")), version), InputError) << type;
            EXPECT_THROW(material(bsdf(type, bsdf("diffuse")), version), InputError) << type;
        }
}

}  // namespace
}  // namespace treefarm
