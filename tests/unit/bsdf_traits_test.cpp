// SPDX-License-Identifier: Apache-2.0
// What the plan says of a material is what its BSDF does.
#include <gtest/gtest.h>

#include <typeinfo>

#include "common/base/random.h"
#include "common/scene/uses/material_traits.h"
#include "tests/support/kind_scenes.h"
#include "worker/shading/bsdf_builder.h"

namespace treefarm {
namespace {

/// Lobes as a sample can tell them apart: diffuse and glossy reflection look alike, and so do a pane and nothing.
struct Seen {
    bool smooth_reflection = false, delta_reflection = false, smooth_transmission = false, delta_transmission = false;
    bool operator==(const Seen&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Seen& seen) {
    return out << "reflection " << seen.smooth_reflection << " (delta " << seen.delta_reflection << "), transmission "
               << seen.smooth_transmission << " (delta " << seen.delta_transmission << ")";
}

Seen promised(const Lobes& lobes) {
    return {lobes.diffuse || lobes.glossy_reflection, lobes.delta_reflection, lobes.glossy_transmission,
            lobes.delta_transmission || lobes.null};
}

Seen sampled(const Bsdf& bsdf) {
    Seen seen;
    for (std::uint32_t i = 0; i < 4000; ++i) {
        const auto bits = draw(PathKey{7, i, 0}, 1, Stream::scatter);
        const float z = 0.2f + 0.75f * to_unit(bits[3]);
        const Vec3 wo(std::sqrt(1.0f - z * z), 0.0f, z);
        const BsdfSample s = bsdf.sample(wo, {to_unit(bits[0]), {to_unit(bits[1]), to_unit(bits[2])}});
        if (!(s.pdf > 0.0f)) continue;
        const bool reflected = s.wi.z > 0.0f;
        (s.delta ? (reflected ? seen.delta_reflection : seen.delta_transmission)
                 : (reflected ? seen.smooth_reflection : seen.smooth_transmission)) = true;
    }
    return seen;
}

void expect_agreement(Scene scene, const char* what) {
    Shape shape;
    shape.geometry = Sphere{};
    shape.material = static_cast<std::int32_t>(scene.materials.size() - 1);
    scene.shapes.push_back(shape);
    const TextureSet textures;
    BsdfBuilder builder(scene, textures);
    const MaterialTraits traits = material_traits(scene, shape.material);
    EXPECT_EQ(builder.varies(shape.material), traits.needs_surface_detail()) << what;
    if (builder.varies(shape.material)) return;
    const bool has_back = traits.lobes.transmits() || traits.twosided;
    for (const bool back : {false, true}) {
        const Bsdf* bsdf = builder.constant(shape.material, back);
        ASSERT_NE(bsdf, nullptr) << what;
        if (back && !has_back) {
            EXPECT_EQ(lobes_of(*bsdf), 0) << what;
            continue;
        }
        EXPECT_EQ((lobes_of(*bsdf) & kSmoothLobe) != 0, traits.lobes.smooth()) << what;
        EXPECT_EQ((lobes_of(*bsdf) & kDeltaLobe) != 0, traits.lobes.delta()) << what;
        EXPECT_EQ((lobes_of(*bsdf) & kViewLobe) != 0, traits.lobes.view_dependent()) << what;
        EXPECT_TRUE(refraction_of(*bsdf) == 1.0f || (lobes_of(*bsdf) & kTransmittingLobe)) << what;
        EXPECT_EQ(sampled(*bsdf), promised(traits.lobes)) << what << (back ? ", back" : ", front");
    }
}

template <class... Kinds>
Scene of(const Kinds&... bsdfs) {
    Scene scene;
    const auto add = [&](const auto& bsdf) {
        Material material;
        material.bsdf = bsdf;
        scene.materials.push_back(material);
    };
    (add(bsdfs), ...);
    return scene;
}

Scene twosided(Scene scene) {
    scene.materials.back().twosided = true;
    return scene;
}

Roughness rough(float u, float v) {
    return {Microfacets::ggx, {u}, {v}};
}

ConductorMaterial metal(const Roughness& roughness) {
    ConductorMaterial conductor;
    conductor.roughness = roughness;
    return conductor;
}

DielectricMaterial glass(const Roughness& roughness) {
    DielectricMaterial dielectric;
    dielectric.roughness = roughness;
    return dielectric;
}

PlasticMaterial plastic(const Roughness& roughness) {
    PlasticMaterial material;
    material.roughness = roughness;
    return material;
}

TEST(BsdfTraits, BsdfsHaveTheLobesThatTheirDescriptionsPromise) {
    expect_agreement(of(DiffuseMaterial{}), "diffuse");
    expect_agreement(twosided(of(DiffuseMaterial{})), "twosided diffuse");
    expect_agreement(of(metal({})), "mirror");
    expect_agreement(of(metal(rough(0.2f, 0.2f))), "rough metal");
    expect_agreement(of(metal(rough(0.2f, 0.4f))), "anisotropic metal");
    expect_agreement(of(glass({})), "glass");
    expect_agreement(of(glass(rough(0.2f, 0.2f))), "rough glass");
    expect_agreement(of(ThinDielectricMaterial{}), "pane");
    expect_agreement(of(plastic({})), "plastic");
    expect_agreement(twosided(of(plastic(rough(0.2f, 0.2f)))), "rough plastic");
    expect_agreement(of(NullMaterial{}), "null");
    expect_agreement(of(RoughDiffuseMaterial{}), "rough diffuse");
    expect_agreement(of(PhongMaterial{}), "Phong");
    expect_agreement(twosided(of(WardMaterial{})), "Ward");
    PrincipledMaterial principled;
    expect_agreement(of(principled), "principled");
    principled.spec_trans = 0.5f;
    expect_agreement(of(principled), "principled glass");
    PrincipledThinMaterial thin;
    expect_agreement(of(thin), "thin principled");
    thin.diff_trans = 0.5f;
    expect_agreement(of(thin), "thin principled that transmits");
    expect_agreement(of(DiffuseTransmitterMaterial{}), "diffuse transmitter");
}

TEST(BsdfTraits, EveryKindKeepsItsPromiseAsItIsByDefault) {
    for_each_kind<MaterialKind>([]<class Kind>() {
        Kind kind;
        test::ReferToTheFirst refer;
        Kind::fields(kind, refer);
        expect_agreement(twosided(of(DiffuseMaterial{}, kind)), typeid(Kind).name());
    });
}

struct HalfOfAll : IgnoreFields {
    using IgnoreFields::fraction;
    void fraction(const char*, FloatInput& input) { input = 0.5f; }
};

/// `effects.transmission = false` puts that form in its place. What is not there at all needs none.
TEST(BsdfTraits, EveryKindThatLightPassesThroughHasAnOpaqueForm) {
    for_each_kind<MaterialKind>([]<class Kind>() {
        Kind kind;
        HalfOfAll half;
        Kind::fields(kind, half);
        const Lobes lobes = kind.lobes();
        if constexpr (requires { kind.opaque(); })
            EXPECT_FALSE(kind.opaque().lobes().transmits()) << typeid(Kind).name();
        else
            EXPECT_FALSE(lobes.glossy_transmission || lobes.delta_transmission) << typeid(Kind).name();
    });
}

TEST(BsdfTraits, SoDoBlends) {
    expect_agreement(of(DiffuseMaterial{}, metal({}), BlendMaterial{{0.5f}, 0, 1}), "paint and mirror");
    expect_agreement(of(glass(rough(0.2f, 0.2f)), NullMaterial{}, BlendMaterial{{0.3f}, 0, 1}), "rough glass and null");
}

TEST(BsdfTraits, SoDoCoats) {
    CoatingMaterial coat;
    coat.coated = 0;
    expect_agreement(twosided(of(DiffuseMaterial{}, coat)), "coated paint");
    expect_agreement(of(NullMaterial{}, coat), "coated nothing");
    coat.roughness = rough(0.2f, 0.2f);
    expect_agreement(twosided(of(metal({}), coat)), "mirror under a rough coat");
}

}  // namespace
}  // namespace treefarm
