// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/scene/model/scene.h"
#include "common/scene/uses/emitter_uses.h"

namespace treefarm::test {

/// Sets each reference of a kind to the first object there is, so that a default kind is complete.
struct ReferToTheFirst : IgnoreFields {
    void part(const char*, std::int32_t& index) { index = 0; }
    void image(std::int32_t& index) { index = 0; }
    void shape(std::int32_t& index) { index = 0; }
    void group(std::int32_t& index) { index = 0; }
};

/// A small scene for each kind of shape, material, emitter and texture, from the lists of kinds, with one object of the
/// kind with default values.
inline std::vector<Scene> kind_scenes() {
    Scene base;
    TextureImage& image = base.images.emplace_back();
    image.width = 1, image.height = 1;
    image.floats = {0.25f, 0.5f, 0.75f};
    base.materials.emplace_back();
    base.shapes = {{Sphere{}, 0, kNone, kNone, "", {}}, {Sphere{}, 0, kNone, 0, "", {}}};
    base.group_count = 1;

    std::vector<Scene> scenes;
    const auto add = [&]<class Kind>(auto put) {
        Kind kind;
        ReferToTheFirst refer;
        Kind::fields(kind, refer);
        Scene& scene = scenes.emplace_back(base);
        put(scene, kind);
    };
    for_each_kind<ShapeKind>([&]<class Kind>() {
        add.template operator()<Kind>([](Scene& scene, const Kind& kind) {
            const std::int32_t material = std::is_same_v<Kind, Instance> ? kNone : 0;
            scene.shapes.push_back({kind, material, kNone, kNone, "", {}});
        });
    });
    for_each_kind<MaterialKind>([&]<class Kind>() {
        add.template operator()<Kind>(
            [](Scene& scene, const Kind& kind) { scene.materials.emplace_back().bsdf = kind; });
    });
    for_each_kind<EmitterKind>([&]<class Kind>() {
        add.template operator()<Kind>([](Scene& scene, const Kind& kind) {
            scene.emitters.push_back({kind, {}});
            if (shape_of(scene.emitters[0]) == 0) scene.shapes[0].emitter = 0;
        });
    });
    for_each_kind<TextureKind>([&]<class Kind>() {
        add.template operator()<Kind>([](Scene& scene, const Kind& kind) { scene.textures.push_back({kind, "", {}}); });
    });
    return scenes;
}

}  // namespace treefarm::test
