// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "common/base/text/parse_text.h"
#include "common/scene/uses/material_traits.h"
#include "coordinator/input/check/validation.h"

namespace treefarm::validation {
namespace {

class MaterialCheck {
  public:
    MaterialCheck(Scene& scene, std::size_t index, const std::vector<ValueRange>& textures,
                  const std::vector<bool>& transmits, std::vector<Warning>& warnings)
        : index_(index),
          material_(scene.materials[index]),
          textures_(textures),
          transmits_(transmits),
          warnings_(warnings) {}

    /// Checks the material. Returns whether it transmits light.
    bool run() {
        passes_ = own_traits(material_).lobes.transmits();
        visit_fields(material_.bsdf, *this);
        if (material_.twosided && passes_)
            refuse("a material that light passes through is twosided", "remove the twosided: it has both sides anyway");
        if (material_.back != kNone) {
            if (!material_.twosided) refuse("only a twosided material can have another one for its back", "");
            if (transmits_[beneath(material_.back)])
                refuse("the material of the back is one that light passes through", "give an opaque one");
        }
        const float opacity = reached_fraction("opacity", material_.opacity);
        if (material_.opacity.varies() && !material_.unlimited)
            material_.opacity.value *= fraction_scale(opacity, "the opacity");
        check_detail(material_.detail);
        return passes_;
    }

    /// Refuses a constant outside 0 to 1. A factor that its texture raises above 1 is scaled down or kept, like in the
    /// program of the file's version.
    void fraction(const char* name, ColorInput& input) {
        const std::string what = std::string("the ") + name;
        for (int i = 0; i < 3; ++i)
            if (!(input.value[i] >= 0.0f && input.value[i] <= (input.varies() ? 1e30f : 1.0f)))
                refuse(what + " is outside 0 to 1", "give values from 0 to 1");
        if (!input.varies()) return;
        const float most = reached(input.texture, max_component(input.value), what);
        if (!material_.keeps_factors())
            input.value *= fraction_scale(most, what);
        else if (most > 1.0f + 1e-5f)
            warnings_.push_back({material_.where, what + " reaches " + std::to_string(most) +
                                                      " in its texture: it sends back more light than it gets"});
    }

    /// A number above 1 from its texture counts as 1.
    void fraction(const char* name, FloatInput& input) { reached_fraction(name, input); }

    void anisotropy(FloatInput& input) { fraction("anisotropy", input); }

    void number(const char* name, const FloatInput& input, float least, float most) const {
        const ValueRange factor = input.varies() ? range(input.texture) : ValueRange{1.0f, 1.0f};
        const float low = input.value * factor.min, high = input.value * factor.max;
        if (std::min(low, high) >= least && std::max(low, high) <= most) return;
        const std::string bounds = number_text(least) + " to " + number_text(most);
        refuse(std::string("the ") + name + " is outside " + bounds, "give values from " + bounds);
    }
    void number(const char* name, const ColorInput& input, float least, float most) const {
        for (int i = 0; i < 3; ++i)
            number(name, FloatInput{input.value[i], input.texture}, least, most);
    }

    /// Scales two reflectances down if their sum exceeds 1, as in Mitsuba 0.6.
    void together(ColorInput& a, ColorInput& b) {
        float sum = 0.0f;
        for (int i = 0; i < 3; ++i)
            sum = std::max(sum, largest(a, i) + largest(b, i));
        if (!(sum > 1.0f)) return;
        a.value /= sum;
        b.value /= sum;
        if (sum > 1.0f + 1e-5f)
            warnings_.push_back({material_.where, "diffuse and specular reflectance add up to " + number_text(sum) +
                                                      " and are scaled down to 1"});
    }

    void choice(const char*, auto, auto) const {}

    void eta(float value) const {
        if (!(value > 0.0f && value <= 1e6f && 1.0f / value <= 1e6f))
            refuse("the index of refraction is not positive or not finite",
                   "give the ratio of the inner to the outer one, above 0");
    }

    void metal(const Rgb& eta, const Rgb& k) const {
        for (int i = 0; i < 3; ++i)  // Fresnel's equations square their squares
            if (!(eta[i] >= 0.0f && k[i] >= 0.0f && eta[i] <= 1e6f && k[i] <= 1e6f))
                refuse("the index of refraction is negative, above 1e6 or not finite",
                       "give an eta and a k from 0 to 1e6");
    }

    void roughness(Roughness& roughness, bool isotropic) {
        if (isotropic && !(roughness.alpha_u == roughness.alpha_v))
            refuse("the roughness of a plastic differs between directions", "give a single alpha");
        if (!roughness.smooth()) check_alpha(roughness);
    }

    void flag(const char*, bool) const {}

    void part(const char*, std::int32_t index) { passes_ = passes_ || transmits_[beneath(index)]; }

  private:
    [[noreturn]] void refuse(const std::string& what, const std::string& cure) const {
        throw InputError(material_.where, what, cure);
    }

    /// Index of a material before this one, so that none contains itself.
    std::size_t beneath(std::int32_t index) const {
        if (index < 0 || static_cast<std::size_t>(index) >= index_)
            refuse("a material contains itself, or one that does not exist", "give it another one");
        return static_cast<std::size_t>(index);
    }

    const ValueRange& range(std::int32_t texture) const {
        if (texture < 0 || static_cast<std::size_t>(texture) >= textures_.size())
            refuse("the material has a texture that does not exist", "define it");
        return textures_[static_cast<std::size_t>(texture)];
    }

    float largest(const ColorInput& input, int channel) const {
        return input.value[channel] * (input.varies() ? range(input.texture).max : 1.0f);
    }

    /// Value to which Mitsuba 0.6 scales a factor that a texture raises above 1.
    static constexpr float kScaledTo = 0.99f;

    /// Largest value that the texture gives to a factor.
    float reached(std::int32_t texture, float largest, const std::string& what) const {
        const ValueRange& values = range(texture);
        if (values.min < 0.0f) refuse(what + " has a texture with negative values", "give values from 0 to 1");
        return largest * values.max;
    }

    /// Largest value of a number. Throws InputError if it is no fraction.
    float reached_fraction(const char* name, const FloatInput& input) const {
        const std::string what = std::string("the ") + name;
        if (!(input.value >= 0.0f && input.value <= (input.varies() ? 1e30f : 1.0f)))
            refuse(what + " is outside 0 to 1", "give a value from 0 to 1");
        return input.varies() ? reached(input.texture, input.value, what) : input.value;
    }

    /// Scale that brings a factor with a maximum of `most` down to its limit; 1 within rounding of the limit.
    float fraction_scale(float most, const std::string& what) {
        if (!(most > 1.0f)) return 1.0f;
        if (most <= 1.0f + 1e-5f) return 1.0f / most;
        warnings_.push_back({material_.where, what + " reaches " + std::to_string(most) +
                                                  " in its texture and is scaled down to 0.99, as by Mitsuba 0.6"});
        return kScaledTo / most;
    }

    void check_alpha(Roughness& roughness) {
        bool raised = false;
        for (FloatInput* alpha : {&roughness.alpha_u, &roughness.alpha_v}) {
            if (!(alpha->value > 0.0f && alpha->value <= 1e6f))
                refuse("the roughness alpha is not positive or not finite", "give a value from 0.0001 to 1");
            if (alpha->varies()) {
                if (range(alpha->texture).min < 0.0f)
                    refuse("the roughness alpha has a texture with negative values", "give values above 0");
            } else if (alpha->value < Roughness::kLeastAlpha) {
                alpha->value = Roughness::kLeastAlpha;
                raised = true;
            }
        }
        if (raised) warnings_.push_back({material_.where, "the roughness alpha is below 0.0001 and is raised to it"});
    }

    void check_detail(const NormalDetail& detail) const {
        if (!std::isfinite(detail.bump_scale)) refuse("the scale of the bump map is not finite", "give a number");
        if (detail.bump != kNone) range(detail.bump);
        if (detail.normal_map == kNone) return;
        range(detail.normal_map);
        if (!is_finite(detail.normal_scale)) refuse("the factor of the normal map is not finite", "give numbers");
    }

    std::size_t index_;
    Material& material_;
    const std::vector<ValueRange>& textures_;
    const std::vector<bool>& transmits_;
    std::vector<Warning>& warnings_;
    bool passes_ = false;
};

}  // namespace

void check_materials(Scene& scene, const std::vector<ValueRange>& textures, std::vector<Warning>& warnings) {
    std::vector<bool> transmits;
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        transmits.push_back(MaterialCheck(scene, i, textures, transmits, warnings).run());
}

}  // namespace treefarm::validation
