// SPDX-License-Identifier: Apache-2.0
#include "common/scene/model/scene.h"

#include <limits>

namespace treefarm {
std::int32_t Scene::environment() const {
    for (std::size_t i = 0; i < emitters.size(); ++i)
        if (emitters[i].type() == LightType::environment) return static_cast<std::int32_t>(i);
    return kNone;
}

Box3 Scene::bounds() const {
    Box3 box;
    std::vector<Box3> groups(static_cast<std::size_t>(group_count));
    for (const Shape& shape : shapes)
        (shape.group == kNone ? box : groups[static_cast<std::size_t>(shape.group)]).extendBy(own_box(shape));
    for (const Shape& shape : shapes) {
        const auto* instance = std::get_if<Instance>(&shape.geometry);
        if (!instance) continue;
        const Box3& group = groups[static_cast<std::size_t>(instance->group)];
        if (group.isEmpty()) continue;
        for (int corner = 0; corner < 8; ++corner)
            box.extendBy(Vec3(corner & 1 ? group.max.x : group.min.x, corner & 2 ? group.max.y : group.min.y,
                              corner & 4 ? group.max.z : group.min.z) *
                         instance->to_world);
    }
    return box;
}

float Scene::radiance_scale() const {
    const Box3 box = bounds();
    const Vec3 size = box.isEmpty() ? Vec3(1.0f) : box.max - box.min;
    const float distance2 = std::max(0.25f * dot(size, size), 1e-30f);
    const LitScene scene{distance2, images};
    const auto of = [&](const auto& emitter) { return emitter.radiance_scale(scene); };
    float scale = 0.0f;
    for (const Emitter& emitter : emitters)
        scale = std::max(scale, std::visit(of, emitter.kind));
    return scale > 0.0f && std::isfinite(scale) ? scale : 1.0f;
}

std::size_t Scene::triangle_count() const {
    std::size_t count = 0;
    for (const Shape& shape : shapes)
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) count += mesh->triangle_count();
    return count;
}

ValueRange Scene::range_of_attribute(const std::string& name) const {
    ValueRange range{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
    for (const Shape& shape : shapes) {
        const auto* mesh = std::get_if<Mesh>(&shape.geometry);
        const MeshAttribute* attribute = mesh ? mesh->find_attribute(name) : nullptr;
        if (!attribute) continue;
        for (const Rgb& value : attribute->values)
            range = range.with(value.x).with(value.y).with(value.z);
    }
    return range.min <= range.max ? range : ValueRange{0.0f, 1.0f};
}

Rgb Scene::mean_of_attribute(const std::string& name) const {
    Imath::V3d sum(0.0);
    std::size_t count = 0;
    for (const Shape& shape : shapes) {
        const auto* mesh = std::get_if<Mesh>(&shape.geometry);
        const MeshAttribute* attribute = mesh ? mesh->find_attribute(name) : nullptr;
        if (!attribute) continue;
        for (const Rgb& value : attribute->values)
            sum += Imath::V3d(value);
        count += attribute->values.size();
    }
    return count > 0 ? Rgb(Vec3(sum / static_cast<double>(count))) : Rgb(0.5f);
}

}  // namespace treefarm
