// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/check/validation.h"

namespace treefarm::validation {
namespace {

class EmitterCheck {
  public:
    EmitterCheck(const Scene& scene, std::size_t index, const std::vector<ValueRange>& images,
                 const std::vector<ValueRange>& textures)
        : scene_(scene), index_(index), images_(images), textures_(textures) {}

    void run() const { visit_fields(emitter().kind, *this); }

    void light(const char* what, const Rgb& value) const {
        for (int i = 0; i < 3; ++i)
            if (!std::isfinite(value[i]) || value[i] < 0.0f)
                refuse(std::string("the emitter's ") + what + " is negative or not finite", "give values of 0 or more");
    }
    void light(const char* what, const ColorInput& input) const {
        light(what, input.value);
        texture(input.texture);
    }
    void light(const char* what, float value) const { light(what, Rgb(value)); }
    void position(const Vec3& position) const {
        if (!is_finite(position) || is_too_far(position))
            refuse("the emitter's position is not finite or beyond 1e18", "check its transformation");
    }
    void direction(const Vec3& direction) const {
        if (!is_finite(direction) || !is_unit(direction))
            refuse("the emitter's direction has no unit length", "check its transformation");
    }
    void value(float) const {}
    void texture(std::int32_t texture) const {
        if (texture == kNone) return;
        if (texture < 0 || at(texture) >= textures_.size())
            refuse("the emitter has a texture that does not exist", "define it");
        if (textures_[at(texture)].min < 0.0f)
            refuse("the emitter's texture has negative values", "give values of 0 or more");
    }
    void image(std::int32_t image) const {
        if (image < 0 || at(image) >= images_.size()) refuse("the " + title() + " has no image", "give it a file");
        if (scene_.images[at(image)].channels != 3)
            refuse("the image of the " + title() + " has no three channels", "give it an RGB image");
        if (images_[at(image)].min < 0.0f)
            refuse("the image of the " + title() + " has negative values", "give values of 0 or more");
    }
    void shape(std::int32_t shape) const {
        if (shape < 0 || at(shape) >= scene_.shapes.size())
            refuse("the " + title() + " has no shape", "put it into a shape");
        if (scene_.shapes[at(shape)].emitter != static_cast<std::int32_t>(index_))
            refuse("the " + title() + " is not its shape's", "give the shape one emitter");
    }
    void flag(const char*, bool) const {}
    void rule(bool holds, const char* what, const char* cure) const {
        if (!holds) refuse(what, cure);
    }

  private:
    static std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }
    const Emitter& emitter() const { return scene_.emitters[index_]; }
    std::string title() const { return emitter().traits().title; }
    [[noreturn]] void refuse(const std::string& what, const char* cure) const {
        throw InputError(emitter().where, what, cure);
    }

    const Scene& scene_;
    std::size_t index_;
    const std::vector<ValueRange>&images_, &textures_;
};

}  // namespace

void check_emitters(const Scene& scene, const std::vector<ValueRange>& images,
                    const std::vector<ValueRange>& textures) {
    std::size_t environments = 0;
    for (std::size_t i = 0; i < scene.emitters.size(); ++i) {
        EmitterCheck(scene, i, images, textures).run();
        if (scene.emitters[i].type() == LightType::environment && ++environments > 1)
            throw InputError(scene.emitters[i].where, "this is a second environment emitter", "keep one of them");
    }
}

}  // namespace treefarm::validation
