#include "common/scene/scene.h"

namespace treefarm {

std::int32_t Scene::environment() const {
    for (std::size_t i = 0; i < emitters.size(); ++i)
        if (std::holds_alternative<ConstantEmitter>(emitters[i].kind)) return static_cast<std::int32_t>(i);
    return kNone;
}

Box3 Scene::bounds() const {
    Box3 box;
    for (const Shape& shape : shapes) {
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
            for (const Vec3& position : mesh->positions)
                box.extendBy(position);
        } else if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
            box.extendBy(sphere->center - Vec3(sphere->radius));
            box.extendBy(sphere->center + Vec3(sphere->radius));
        }
    }
    return box;
}

std::size_t Scene::triangle_count() const {
    std::size_t count = 0;
    for (const Shape& shape : shapes)
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) count += mesh->triangle_count();
    return count;
}

}  // namespace treefarm
