// SPDX-License-Identifier: Apache-2.0
#include "common/scene/validation.h"

namespace treefarm::validation {
namespace {

void check_light(const Rgb& light, const char* what, const Location& where) {
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(light[i]) || light[i] < 0.0f)
            throw InputError(where, std::string("the emitter's ") + what + " is negative or not finite",
                             "give values of 0 or more");
}

void check_position(const Vec3& position, const Location& where) {
    if (!is_finite(position) || is_too_far(position))
        throw InputError(where, "the emitter's position is not finite or beyond 1e18", "check its transformation");
}

void check_direction(const Vec3& direction, const Location& where) {
    if (!is_finite(direction) || !is_unit(direction))
        throw InputError(where, "the emitter's direction has no unit length", "check its transformation");
}

class EmitterCheck {
  public:
    EmitterCheck(const Scene& scene, const std::vector<ValueRange>& images, const std::vector<ValueRange>& textures,
                 const Location& where)
        : scene_(scene), images_(images), textures_(textures), where_(where) {}

    void operator()(const AreaEmitter& e) const {
        check_light(e.radiance.value, "radiance", where_);
        if (e.radiance.varies()) check_texture(e.radiance.texture);
        if (e.shape < 0 || static_cast<std::size_t>(e.shape) >= scene_.shapes.size())
            throw InputError(where_, "the area emitter has no shape", "put it into a shape");
    }
    void operator()(const PointEmitter& e) const {
        check_light(e.intensity, "intensity", where_);
        check_position(e.position, where_);
    }
    void operator()(const SpotEmitter& e) const {
        check_light(e.intensity, "intensity", where_);
        check_position(e.position, where_);
        check_direction(e.axis, where_);
        if (!(e.cutoff > 0.0f && e.cutoff <= kPi))
            throw InputError(where_, "the spot's cutoff angle is not above 0 and at most 180 degrees",
                             "give an angle between");
        if (!(e.beam >= 0.0f && e.beam <= e.cutoff))
            throw InputError(where_, "the spot's beam is wider than its cutoff angle, or negative",
                             "give a beam width from 0 to the cutoff angle");
        if (e.texture == kNone) return;
        check_texture(e.texture);
        check_direction(e.x_axis, where_);
        check_direction(e.y_axis, where_);
        if (!(e.cutoff < 0.5f * kPi))
            throw InputError(where_, "the cone of a spot with a texture is a half space or more",
                             "give a cutoff angle below 90 degrees");
    }
    void operator()(const DirectionalEmitter& e) const {
        check_light(e.irradiance, "irradiance", where_);
        check_direction(e.direction, where_);
    }
    void operator()(const ConstantEmitter& e) const { check_light(e.radiance, "radiance", where_); }
    void operator()(const EnvironmentEmitter& e) const {
        const auto image = static_cast<std::size_t>(e.image);
        if (e.image < 0 || image >= images_.size())
            throw InputError(where_, "the environment has no image", "give it a file");
        if (scene_.images[image].channels != 3)
            throw InputError(where_, "the environment's image has no three channels", "give it an RGB image");
        if (images_[image].min < 0.0f)
            throw InputError(where_, "the environment's image has negative values", "give values of 0 or more");
        if (!std::isfinite(e.scale) || e.scale < 0.0f)
            throw InputError(where_, "the environment's scale is negative or not finite", "give a value of 0 or more");
        for (const Vec3& axis : {e.x_axis, e.y_axis, e.z_axis})
            check_direction(axis, where_);
        if (std::abs(dot(e.x_axis, e.y_axis)) > 1e-3f || std::abs(dot(e.y_axis, e.z_axis)) > 1e-3f ||
            std::abs(dot(e.z_axis, e.x_axis)) > 1e-3f)
            throw InputError(where_, "the environment's axes are not at right angles", "only rotate it");
    }

  private:
    void check_texture(std::int32_t index) const {
        const auto texture = static_cast<std::size_t>(index);
        if (index < 0 || texture >= textures_.size())
            throw InputError(where_, "the emitter has a texture that does not exist", "define it");
        if (textures_[texture].min < 0.0f)
            throw InputError(where_, "the emitter's texture has negative values", "give values of 0 or more");
    }

    const Scene& scene_;
    const std::vector<ValueRange>&images_, &textures_;
    const Location& where_;
};

}  // namespace

void check_emitters(const Scene& scene, const std::vector<ValueRange>& images,
                    const std::vector<ValueRange>& textures) {
    std::size_t environments = 0;
    for (std::size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        std::visit(EmitterCheck(scene, images, textures, emitter.where), emitter.kind);
        if (const auto* area = std::get_if<AreaEmitter>(&emitter.kind))
            if (scene.shapes[static_cast<std::size_t>(area->shape)].emitter != static_cast<std::int32_t>(i))
                throw InputError(emitter.where, "the area emitter is not its shape's", "give the shape one emitter");
        const bool is_environment = std::holds_alternative<ConstantEmitter>(emitter.kind) ||
                                    std::holds_alternative<EnvironmentEmitter>(emitter.kind);
        if (is_environment && ++environments > 1)
            throw InputError(emitter.where, "this is a second environment emitter", "keep one of them");
    }
}

}  // namespace treefarm::validation
