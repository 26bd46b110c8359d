// SPDX-License-Identifier: Apache-2.0
#include "common/plan/effects/approximation.h"

#include <cmath>
#include <optional>

#include "common/config/effect_switches.h"
#include "common/config/effects/table.h"
#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_traits.h"
#include "common/scene/uses/material_uses.h"
#include "common/scene/uses/texture_mean.h"

namespace treefarm {
namespace {

struct MakeIsotropic : IgnoreFields {
    bool changed = false;
    void anisotropy(FloatInput& input) {
        if (!input.varies() && input.value == 0.0f) return;
        changed = true;
        input = 0.0f;
    }
    void roughness(Roughness& roughness, bool) {
        if (!roughness.anisotropic()) return;
        changed = true;
        if (!roughness.alpha_u.varies() && !roughness.alpha_v.varies())
            roughness.alpha_u = std::sqrt(roughness.alpha_u.value * roughness.alpha_v.value);
        roughness.alpha_v = roughness.alpha_u;
    }
};

/// Opaque form of a material that transmits light; empty for other materials.
std::optional<MaterialKind> opaque_form(const Material& material) {
    return std::visit(
        [](const auto& kind) -> std::optional<MaterialKind> {
            if constexpr (requires { kind.opaque(); })
                if (kind.lobes().transmits()) return kind.opaque();
            return std::nullopt;
        },
        material.bsdf);
}

/// Removes effects from a scene and counts their uses. Materials that no shape uses stay unchanged: they are not
/// simulated.
class Remover {
  public:
    explicit Remover(Scene& scene) : scene_(scene), used_(used_materials(scene)) {}

    int uses() const { return uses_; }
    const Location& where() const { return where_; }

    void textures() {
        for_used([&](Material& material) {
            for_each_input(material, [&](auto& input) {
                if (!input.varies()) return;
                note(scene_.textures[static_cast<std::size_t>(input.texture)].where);
                flatten(input);
            });
        });
    }

    void masks() {
        for (const Shape& shape : scene_.shapes) {
            if (shape.material == kNone) continue;
            Material& material = scene_.materials[static_cast<std::size_t>(shape.material)];
            if (!material.masked()) continue;
            note(material.where);
            material.opacity = 1.0f;
        }
    }

    void bump() {
        for_used([&](Material& material) {
            if (material.detail.bump == kNone) return;
            note(material.where);
            material.detail.bump = kNone;
        });
    }

    void normal_maps() {
        for_used([&](Material& material) {
            if (material.detail.normal_map == kNone) return;
            note(material.where);
            material.detail.normal_map = kNone;
        });
    }

    void transmission() {
        for_used([&](Material& material) {
            if (std::optional<MaterialKind> opaque = opaque_form(material)) {
                note(material.where);
                material.bsdf = *std::move(opaque);
            }
        });
    }

    void anisotropy() {
        for_used([&](Material& material) {
            MakeIsotropic make;
            visit_fields(material.bsdf, make);
            if (make.changed) note(material.where);
        });
    }

    void textured_area() {
        for (Emitter& emitter : scene_.emitters) {
            if (emitter.type() != LightType::area || !is_textured(emitter)) continue;
            note(emitter.where);
            visit_fields(emitter.kind, FlattenLight{{}, *this});
        }
    }

    void delta_lights() { remove_emitters(LightType::delta); }
    void environment() { remove_emitters(LightType::environment); }

    void lens() {
        if (!scene_.camera.has_lens()) return;
        note({});
        scene_.camera.lens_u = scene_.camera.lens_v = Vec3(0.0f);
    }

  private:
    void note(const Location& where) {
        if (uses_++ == 0) where_ = where;
    }

    template <class F>
    void for_used(F&& f) {
        for (std::size_t i = 0; i < scene_.materials.size(); ++i)
            if (used_[i]) f(scene_.materials[i]);
    }

    void flatten(ColorInput& input) { input = ColorInput(input.value * texture_mean(scene_, input.texture)); }
    void flatten(FloatInput& input) { input = FloatInput(input.value * average(texture_mean(scene_, input.texture))); }

    struct FlattenLight : IgnoreFields {
        Remover& remover;
        void light(const char*, auto& value) {
            if constexpr (requires { value.varies(); })
                if (value.varies()) remover.flatten(value);
        }
    };

    void remove_emitters(LightType type) {
        std::vector<Emitter> kept;
        for (Emitter& emitter : scene_.emitters) {
            if (emitter.type() == type) {
                note(emitter.where);
                continue;
            }
            if (const std::int32_t shape = shape_of(emitter); shape != kNone)
                scene_.shapes[static_cast<std::size_t>(shape)].emitter = static_cast<std::int32_t>(kept.size());
            kept.push_back(std::move(emitter));
        }
        scene_.emitters = std::move(kept);
    }

    Scene& scene_;
    const std::vector<bool> used_;
    int uses_ = 0;
    Location where_;
};

/// Removes the effect of this name, as its row says.
void remove_effect(const std::string& name, Remover& remover) {
    for_each_effect([&](const auto& row) {
        if constexpr (kHasSwitch<decltype(row.off)>)
            if (name == row.text.name) row.off.remove(remover);
    });
}

}  // namespace

std::vector<Approximation> switch_effects_off(Scene& scene, const Job& job) {
    std::vector<Approximation> approximations;
    for (const EffectSwitch& effect : effect_switches()) {
        if (!job.effects.off.contains(effect.name)) continue;
        Remover remover(scene);
        remove_effect(effect.name, remover);
        if (remover.uses() > 0)
            approximations.push_back({effect.name, remover.uses(), remover.where(), effect.replacement});
    }
    strip_scene(scene);
    return approximations;
}

}  // namespace treefarm
