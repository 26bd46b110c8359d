// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "coordinator/input/lint/lint.h"

namespace treefarm::linting {
namespace {

using enum Finding::Severity;

/// Ranges of a scene's images and mesh attributes; 0 to 1 for missing ones.
struct Ranges {
    const Scene& scene;

    ValueRange range_of_image(std::int32_t index) const {
        if (index < 0 || static_cast<std::size_t>(index) >= scene.images.size()) return {0.0f, 1.0f};
        const TextureImage& image = scene.images[static_cast<std::size_t>(index)];
        ValueRange range;
        for (const float value : image.floats)
            range = range.with(value);
        for (const std::uint8_t byte : image.bytes)
            range = range.with(image.decode[byte]);
        return range;
    }
    ValueRange range_of_attribute(const std::string& name) const { return scene.range_of_attribute(name); }
};

/// The largest value of a texture.
float largest_of(const Scene& scene, std::int32_t texture) {
    if (texture < 0 || static_cast<std::size_t>(texture) >= scene.textures.size()) return 1.0f;
    return std::visit([&](const auto& kind) { return kind.range(Ranges{scene}).max; },
                      scene.textures[static_cast<std::size_t>(texture)].kind);
}

class MaterialLint {
  public:
    MaterialLint(const Scene& scene, const Material& material, std::vector<Finding>& findings)
        : scene_(scene), material_(material), findings_(findings) {}

    void run() {
        visit_fields(material_.bsdf, *this);
        if (!material_.unlimited || !material_.opacity.varies())
            factor(material_.opacity.value, material_.opacity.value, material_.opacity.varies(),
                   material_.opacity.texture, "opacity");
    }

    void fraction(const char* what, const ColorInput& input) {
        const auto [least, most] = std::minmax({input.value.x, input.value.y, input.value.z});
        const bool finite = is_finite(input.value);
        factor(least, finite ? most : std::numeric_limits<float>::infinity(), input.varies(), input.texture, what);
    }
    /// A number above 1 from its texture counts as 1.
    void fraction(const char* what, const FloatInput& input) {
        if (!input.varies()) factor(input.value, input.value, false, input.texture, what);
    }
    void anisotropy(const FloatInput& input) { fraction("anisotropy", input); }
    void number(const char* what, const FloatInput& input, float least, float most) {
        const float reached = reached_by(input);
        if (!(reached >= least && reached <= most))
            add(error, "numbers", std::string("a ") + what + " of " + short_number(double(reached)),
                "give " + short_number(double(least)) + " to " + short_number(double(most)));
    }
    void number(const char* what, const ColorInput& input, float least, float most) {
        for (int i = 0; i < 3; ++i) {
            const FloatInput channel(input.value[i], input.texture);
            if (!(reached_by(channel) >= least && reached_by(channel) <= most))
                return number(what, channel, least, most);  // reported once
        }
    }
    void together(const ColorInput& a, const ColorInput& b) {
        const auto most = [&](const ColorInput& input, int i) {
            return input.value[i] * (input.varies() ? largest_of(scene_, input.texture) : 1.0f);
        };
        float sum = 0.0f;
        for (int i = 0; i < 3; ++i)
            sum = std::max(sum, most(a, i) + most(b, i));
        if (sum > 1.0f + 1e-5f)
            add(warning, "energy gain",
                "a diffuse and a specular reflectance that add up to " + short_number(double(sum)) +
                    ": it would send back more light than it gets",
                "they are scaled down to 1");
    }
    void choice(const char*, auto, auto) {}
    void metal(const Rgb& eta, const Rgb& k) {
        for (int i = 0; i < 3; ++i)
            if (!(eta[i] >= 0.0f && eta[i] <= 1e6f && k[i] >= 0.0f && k[i] <= 1e6f))
                return add(error, "extreme ior",
                           "an index of refraction of " + short_number(double(eta[i])) + " + " +
                               short_number(double(k[i])) + " i",
                           "give an eta and a k from 0 to 1e6");
    }
    void eta(float ratio) {
        const std::string value = "an index of refraction of " + short_number(double(ratio));
        if (!(ratio >= 1e-6f && ratio <= 1e6f)) return add(error, "extreme ior", value, "give 1e-6 to 1e6");
        if (std::abs(ratio - 1.0f) <= 1e-4f) {
            // Others have colours beneath their boundary.
            if (std::holds_alternative<DielectricMaterial>(material_.bsdf) ||
                std::holds_alternative<ThinDielectricMaterial>(material_.bsdf))
                add(warning, "extreme ior", value, "the surface is invisible");
            return;
        }
        if (ratio > 4.0f || ratio < 0.25f) add(warning, "extreme ior", value, "glass has 1.5, diamond 2.4");
    }
    void roughness(const Roughness& r, bool) {
        if (r.smooth()) return;
        for (const FloatInput* alpha : {&r.alpha_u, &r.alpha_v}) {
            if (alpha->varies()) continue;
            const std::string value = "a roughness alpha of " + short_number(double(alpha->value));
            if (!(alpha->value > 0.0f && alpha->value <= 1e6f))
                add(error, "extreme alpha", value, "give 0.0001 to 1");
            else if (alpha->value < Roughness::kLeastAlpha)
                add(warning, "extreme alpha", value, "it is raised to 0.0001; take the smooth material");
            // The reader raises smaller values to the minimum, and warns.
            else if (alpha->value < 1e-3f && alpha->value != Roughness::kLeastAlpha)
                add(note, "extreme alpha", value, "the smooth material looks the same and has less noise");
            else if (alpha->value > 1.0f)
                add(warning, "extreme alpha", value, "values above 1 lose energy; give at most 1");
            if (r.alpha_u == r.alpha_v) break;
        }
    }
    void flag(const char*, bool) {}
    void part(const char*, std::int32_t) {}

  private:
    float reached_by(const FloatInput& input) const {
        return input.varies() ? input.value * largest_of(scene_, input.texture) : input.value;
    }

    void add(Finding::Severity severity, const char* kind, const std::string& what, const std::string& cure) {
        findings_.push_back(
            {severity, kind, material_.where, named("material", material_.name) + " has " + what, cure});
    }

    /// Finding about a factor above 1: a constant is refused; that of a texture is scaled down, or kept.
    void factor(float least, float most, bool varies, std::int32_t texture, const char* what) {
        if (!std::isfinite(most) || least < 0.0f)
            return add(error, "numbers", std::string("a ") + what + " that is negative or not finite", "give 0 to 1");
        const float reached = varies ? most * largest_of(scene_, texture) : most;
        if (reached > 1.0f + 1e-5f)
            add(varies ? warning : error, "energy gain",
                std::string("a ") + what + " of up to " + short_number(double(reached)) +
                    ": it would send back more light than it gets",
                !varies                     ? "give 0 to 1"
                : material_.keeps_factors() ? "it is kept, as in Mitsuba 2 and 3; a darker texture keeps the energy"
                                            : "it is scaled down to 0.99, as in Mitsuba 0.6");
    }
    const Scene& scene_;
    const Material& material_;
    std::vector<Finding>& findings_;
};

}  // namespace

void lint_materials(const Scene& scene, std::vector<Finding>& findings) {
    for (const Material& material : scene.materials)
        MaterialLint(scene, material, findings).run();
    for (const TextureImage& image : scene.images) {
        const auto bad = std::count_if(image.floats.begin(), image.floats.end(),
                                       [](float v) { return !std::isfinite(v) || v < 0.0f; });
        if (bad > 0)
            findings.push_back({error, "numbers", Location{image.name},
                                "the image has " + std::to_string(bad) + " values that are negative or not finite",
                                "repair the image"});
    }
}

}  // namespace treefarm::linting
