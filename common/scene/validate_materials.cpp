#include <algorithm>

#include "common/scene/validation.h"

namespace treefarm::validation {
namespace {

class MaterialCheck {
  public:
    MaterialCheck(Scene& scene, std::size_t index, const std::vector<ValueRange>& textures,
                  const std::vector<bool>& transmits, std::vector<Warning>& warnings)
        : scene_(scene),
          index_(index),
          material_(scene.materials[index]),
          textures_(textures),
          transmits_(transmits),
          warnings_(warnings) {}

    /// Whether light passes through the material.
    bool run() {
        const auto* plastic = std::get_if<PlasticMaterial>(&material_.bsdf);
        // What is reflected back and forth between such a base and its coat would grow without end.
        limited_ = !material_.unlimited || (plastic && plastic->nonlinear);
        const bool transmits = std::visit(*this, material_.bsdf);
        if (material_.twosided && transmits)
            refuse("a material that light passes through is twosided", "remove the twosided: it has both sides anyway");
        if (material_.back != kNone) {
            if (!material_.twosided) refuse("only a twosided material can have another one for its back", "");
            if (transmits_[beneath(material_.back)])
                refuse("the material of the back is one that light passes through", "give an opaque one");
        }
        check_fraction(material_.opacity, "the opacity", !material_.unlimited);
        check_detail(material_.detail);
        return transmits;
    }

    bool operator()(DiffuseMaterial& m) {
        check_fraction(m.reflectance, "the reflectance");
        return false;
    }
    bool operator()(ConductorMaterial& m) {
        for (int i = 0; i < 3; ++i)  // Fresnel's equations square their squares
            if (!(m.eta[i] >= 0.0f && m.k[i] >= 0.0f && m.eta[i] <= 1e6f && m.k[i] <= 1e6f))
                refuse("the index of refraction is negative, above 1e6 or not finite",
                       "give an eta and a k from 0 to 1e6");
        check_fraction(m.specular_reflectance, "the specular reflectance");
        check_roughness(m.roughness);
        return false;
    }
    bool operator()(DielectricMaterial& m) {
        check_eta(m.eta);
        check_fraction(m.specular_reflectance, "the specular reflectance");
        check_fraction(m.specular_transmittance, "the specular transmittance");
        check_roughness(m.roughness);
        return true;
    }
    bool operator()(ThinDielectricMaterial& m) {
        check_eta(m.eta);
        check_fraction(m.specular_reflectance, "the specular reflectance");
        check_fraction(m.specular_transmittance, "the specular transmittance");
        return true;
    }
    bool operator()(PlasticMaterial& m) {
        check_eta(m.eta);
        check_fraction(m.diffuse_reflectance, "the diffuse reflectance");
        check_fraction(m.specular_reflectance, "the specular reflectance");
        if (!(m.roughness.alpha_u == m.roughness.alpha_v))
            refuse("the roughness of a plastic differs between directions", "give a single alpha");
        check_roughness(m.roughness);
        return false;
    }
    bool operator()(BlendMaterial& m) {
        check_fraction(m.weight, "the weight of the blend", false);
        const std::size_t first = beneath(m.first), second = beneath(m.second);
        return transmits_[first] || transmits_[second];
    }
    bool operator()(NullMaterial&) { return true; }

  private:
    [[noreturn]] void refuse(const std::string& what, const std::string& cure) const {
        throw InputError(material_.where, what, cure);
    }

    /// The index of a material that stands before this one, so that none contains itself.
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

    /// Share of 1 to which Mitsuba 0.6 scales a factor that a texture takes above it.
    static constexpr float kScaledTo = 0.99f;

    /// The most that the texture takes a factor to.
    float reached(std::int32_t texture, float largest, const std::string& what) const {
        const ValueRange& values = range(texture);
        if (values.min < 0.0f) refuse(what + " has a texture with negative values", "give values from 0 to 1");
        return largest * values.max;
    }

    /// What brings a factor that its texture takes to `most` down to its limit; 1 within rounding of the limit.
    float fraction_scale(float most, const std::string& what) {
        if (!(most > 1.0f)) return 1.0f;
        if (most <= 1.0f + 1e-5f) return 1.0f / most;
        warnings_.push_back({material_.where, what + " reaches " + std::to_string(most) +
                                                  " in its texture and is scaled down to 0.99, as by Mitsuba 0.6"});
        return kScaledTo / most;
    }

    void check_fraction(ColorInput& input, const std::string& what) {
        for (int i = 0; i < 3; ++i)
            if (!(input.value[i] >= 0.0f && input.value[i] <= (input.varies() ? 1e30f : 1.0f)))
                refuse(what + " is outside 0 to 1", "give values from 0 to 1");
        if (!input.varies()) return;
        const float most = reached(input.texture, max_component(input.value), what);
        if (limited_)
            input.value *= fraction_scale(most, what);
        else if (most > 1.0f + 1e-5f)
            warnings_.push_back({material_.where, what + " reaches " + std::to_string(most) +
                                                      " in its texture: it sends back more light than it gets"});
    }

    /// A number that is not `scaled` counts as 1 wherever its texture takes it above.
    void check_fraction(FloatInput& input, const std::string& what, bool scaled) {
        if (!(input.value >= 0.0f && input.value <= (input.varies() ? 1e30f : 1.0f)))
            refuse(what + " is outside 0 to 1", "give a value from 0 to 1");
        if (!input.varies()) return;
        const float most = reached(input.texture, input.value, what);
        if (scaled) input.value *= fraction_scale(most, what);
    }

    void check_eta(float eta) const {
        if (!(eta > 0.0f && eta <= 1e6f && 1.0f / eta <= 1e6f))
            refuse("the index of refraction is not positive or not finite",
                   "give the ratio of the inner to the outer one, above 0");
    }

    void check_roughness(Roughness& roughness) {
        if (roughness.smooth()) return;
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
        if (!std::holds_alternative<BitmapTexture>(scene_.textures[static_cast<std::size_t>(detail.normal_map)].kind))
            refuse("the normal map is no bitmap", "give it an image");
    }

    const Scene& scene_;
    std::size_t index_;
    Material& material_;
    const std::vector<ValueRange>& textures_;
    const std::vector<bool>& transmits_;
    std::vector<Warning>& warnings_;
    bool limited_ = true;  ///< factors on light stay at or below 1
};

}  // namespace

void check_materials(Scene& scene, const std::vector<ValueRange>& textures, std::vector<Warning>& warnings) {
    std::vector<bool> transmits;
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        transmits.push_back(MaterialCheck(scene, i, textures, transmits, warnings).run());
}

}  // namespace treefarm::validation
