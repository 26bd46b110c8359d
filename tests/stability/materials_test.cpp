// SPDX-License-Identifier: Apache-2.0
// Kinds of materials at the ends of what their inputs may be.
#include <algorithm>
#include <typeinfo>

#include "common/base/random.h"
#include "coordinator/input/check/validate.h"
#include "tests/support/hard_case.h"
#include "tests/support/kind_scenes.h"
#include "tests/support/material_scenes.h"

namespace treefarm {
namespace {

/// Gives each input of a kind one of the ends of its range, or what lies between, by random numbers.
class EndsOfRanges : public test::ReferToTheFirst {
  public:
    explicit EndsOfRanges(std::uint32_t number) : number_(number) {}

    void fraction(const char*, FloatInput& input) { input = one_of({0.0f, 1e-30f, 1e-3f, 0.5f, 1.0f}); }
    void fraction(const char*, ColorInput& input) { input = color({0.0f, 1e-30f, 0.5f, 1.0f}); }
    void anisotropy(FloatInput& input) { input = one_of({0.0f, 0.5f, 1.0f}); }
    void number(const char*, FloatInput& input, float least, float most) { input = one_of({least, 0.5f, most}); }
    void number(const char*, ColorInput& input, float least, float most) { input = color({least, 0.5f, most}); }
    void together(const ColorInput&, const ColorInput&) {}
    void eta(float& ratio) { ratio = one_of({1e-6f, 0.5f, 1.0001f, 1.5f, 1e6f}); }
    void metal(Rgb& eta, Rgb& k) {
        eta = color({0.0f, 1.5f, 1e6f});
        k = color({1e-3f, 4.0f, 1e6f});
    }
    void roughness(Roughness& roughness, bool isotropic) {
        if (roughness.smooth() && one_of({0.0f, 1.0f}) > 0.0f) return;  // a kind that may be smooth
        roughness.distribution = one_of({0.0f, 1.0f}) > 0.0f ? Microfacets::ggx : Microfacets::beckmann;
        roughness.alpha_u = one_of({1e-4f, 0.1f, 1.0f, 1e6f});
        roughness.alpha_v = isotropic ? roughness.alpha_u.value : one_of({1e-4f, 0.1f, 1e6f});
    }
    void flag(const char*, bool& value) { value = one_of({0.0f, 1.0f}) > 0.0f; }

  private:
    float one_of(std::initializer_list<float> values) {
        const Draw r = draw({31, number_, input_++}, 0, Stream::scatter);
        return values.begin()[r[0] % values.size()];
    }
    Rgb color(std::initializer_list<float> values) { return {one_of(values), one_of(values), one_of(values)}; }

    std::uint32_t number_, input_ = 0;
};

/// ours | Every kind of material with all of its inputs at the ends of their ranges
/// Others: the cases above were each one model at one value of one input.
/// Here: inputs are checked once, by what they are, and each BSDF is finite for whatever passes.
/// Holds: 400 materials of each kind at grazing and other angles: values, densities and samples are finite and not
/// negative, and a sample carries the value and the density of its direction.
TEST(Materials, EndsOfTheirRanges) {
    double most = 0;
    for_each_kind<MaterialKind>([&]<class Kind>() {
        for (std::uint32_t number = 0; number < 400; ++number) {
            Scene scene;
            test::add_diffuse(scene, Rgb(0.5f));
            Kind kind;
            EndsOfRanges ends(number);
            Kind::fields(kind, ends);
            const std::int32_t material = test::add_material(scene, kind, number % 2 == 1 && !kind.lobes().transmits());
            test::add_shape(scene, test::quad(Vec3(0.0f), Vec3(1, 0, 0), Vec3(0, 1, 0)), material);
            std::vector<Warning> warnings;
            validate_scene(scene, warnings);
            test::PreparedMaterial prepared(std::move(scene));
            for (const bool back : {false, true})
                for (const float cos : {1.0f, 0.5f, 1e-3f, 1e-20f}) {
                    const Vec3 wo(std::sqrt(1.0f - cos * cos), 0.0f, cos);
                    const ShadingPoint point{Vec2(0.0f), Vec3(1, 0, 0), Vec3(0, 1, 0), wo, back};
                    const Bsdf* bsdf = prepared.varies() ? &prepared.at(point, back) : prepared.side(back);
                    for (std::uint32_t i = 0; bsdf && i < 8; ++i) {
                        const Draw r = draw({37, i, number}, 0, Stream::scatter);
                        const BsdfSample s = bsdf->sample(wo, {to_unit(r[1]), {to_unit(r[2]), to_unit(r[3])}});
                        ASSERT_TRUE(is_finite(s.f_cos) && std::isfinite(s.pdf)) << typeid(Kind).name() << number;
                        if (!(s.pdf > 0.0f)) continue;
                        ASSERT_TRUE(std::min({s.f_cos.x, s.f_cos.y, s.f_cos.z}) >= 0.0f)
                            << typeid(Kind).name() << number;
                        const double ratio =
                            s.wi.z < 0.0f ? double(refraction_of(*bsdf)) : 1.0;  // of radiance, squared
                        most = std::max(most, double(max_component(s.f_cos)) / double(s.pdf) * ratio * ratio);
                        if (s.delta) continue;
                        const BsdfValue v = bsdf->value(wo, s.wi);
                        ASSERT_EQ(v.pdf, s.pdf) << typeid(Kind).name() << number;
                        ASSERT_EQ(v.f_cos, s.f_cos) << typeid(Kind).name() << number;
                    }
                }
        }
    });
    test::figure("largest weight of a sample, as power", most);
}

/// Hanrahan and Krueger's equations 8 and 9 as they stand, for isotropic scattering.
long double layer_f_cos(long double s, long double t, long double cos_o, long double cos_i, bool reflects) {
    const long double phase = s / t / (4 * 3.14159265358979323846L);
    if (reflects) return phase * cos_i / (cos_o + cos_i) * -std::expm1(-t * (1 / cos_o + 1 / cos_i));
    if (cos_o == cos_i) return phase * t / cos_o * std::exp(-t / cos_o);
    return phase * cos_i / (cos_o - cos_i) * (std::exp(-t / cos_o) - std::exp(-t / cos_i));
}

/// ours | A layer that scatters light once, from next to nothing to opaque, at all angles
/// Others: Mitsuba 0.6 subtracts two exponentials and divides by the difference of two cosines, which it calls equal
/// within 1e-4 (src/bsdfs/hk.cpp); thin layers lose digits.
/// Here: both ways are written as a mean transmittance, (1 - e^-x)/x by a series near 0.
/// Holds: depths of 1e-8 to 1e4 and cosines of 1e-4 to 1, equal or nearly equal ones among them: relative error below
/// 2e-5 against the equations in long double.
TEST(Materials, ThinLayersKeepTheirDigits) {
    test::Worst worst;
    for (const float depth : {1e-8f, 1e-5f, 1e-3f, 0.1f, 1.0f, 20.0f, 1e4f}) {
        const test::PreparedMaterial layer(ThinLayerMaterial{Rgb(0.75f * depth), Rgb(0.25f * depth), {0.0f}});
        for (const float cos_o : {1e-4f, 0.01f, 0.3f, 0.9f, 1.0f})
            for (const float cos_i : {1e-4f, 1.00001e-4f, 0.01f, 0.299999f, 0.3f, 0.300001f, 0.9f, 1.0f})
                for (const bool reflects : {true, false}) {
                    const Vec3 wo(std::sqrt(1.0f - cos_o * cos_o), 0.0f, cos_o),
                        wi(0.0f, std::sqrt(1.0f - cos_i * cos_i), reflects ? cos_i : -cos_i);
                    const auto exact = double(layer_f_cos(0.75L * depth, depth, cos_o, cos_i, reflects));
                    const double f_cos = double(layer.front().value(wo, wi).f_cos.y);
                    if (exact > 1e-30) worst.see(std::abs(f_cos / exact - 1.0), depth, cos_o);
                }
    }
    EXPECT_LE(worst.value, 2e-5) << worst.where;
    test::figure("relative error", worst.value);
}

}  // namespace
}  // namespace treefarm
