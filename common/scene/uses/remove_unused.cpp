// SPDX-License-Identifier: Apache-2.0
#include "common/scene/uses/remove_unused.h"

#include <utility>

#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_uses.h"
#include "common/scene/uses/texture_uses.h"

namespace treefarm {
namespace {

/// Marks of the used elements of a list, and their new indices.
class Usage {
  public:
    explicit Usage(std::size_t count) : kept_(count, kNone) {}

    void mark(std::int32_t index) {
        if (index >= 0 && static_cast<std::size_t>(index) < kept_.size()) kept_[static_cast<std::size_t>(index)] = 0;
    }
    bool marked(std::size_t index) const { return kept_[index] != kNone; }

    /// Removes unmarked elements and renumbers the others.
    template <class T>
    void compact(std::vector<T>& list) {
        std::int32_t next = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (!marked(i)) continue;
            kept_[i] = next;
            if (static_cast<std::size_t>(next) != i) list[static_cast<std::size_t>(next)] = std::move(list[i]);
            ++next;
        }
        list.resize(static_cast<std::size_t>(next));
    }

    void renumber(std::int32_t& index) const {
        if (index >= 0 && static_cast<std::size_t>(index) < kept_.size())
            index = kept_[static_cast<std::size_t>(index)];
    }

    std::vector<std::int32_t> take() && { return std::move(kept_); }

  private:
    std::vector<std::int32_t> kept_;
};

}  // namespace

std::vector<std::int32_t> remove_unused(Scene& scene) {
    Usage materials(scene.materials.size()), textures(scene.textures.size()), images(scene.images.size());
    for (const Shape& shape : scene.shapes)
        materials.mark(shape.material);
    // Parts of a material have smaller indices: from the top down every whole comes before its parts.
    for (std::size_t i = scene.materials.size(); i-- > 0;)
        if (materials.marked(i)) for_each_part(scene.materials[i], [&](std::int32_t part) { materials.mark(part); });
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (materials.marked(i))
            for_each_texture(scene.materials[i], [&](std::int32_t texture) { textures.mark(texture); });
    for (const Emitter& emitter : scene.emitters) {
        for_each_texture(emitter, [&](std::int32_t texture) { textures.mark(texture); });
        for_each_image(emitter, [&](std::int32_t image) { images.mark(image); });
    }
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
        if (textures.marked(i)) for_each_image(scene.textures[i], [&](std::int32_t image) { images.mark(image); });

    materials.compact(scene.materials);
    textures.compact(scene.textures);
    images.compact(scene.images);

    for (Shape& shape : scene.shapes)
        materials.renumber(shape.material);
    for (Material& material : scene.materials) {
        for_each_part(material, [&](std::int32_t& part) { materials.renumber(part); });
        for_each_texture(material, [&](std::int32_t& texture) { textures.renumber(texture); });
    }
    for (Texture& texture : scene.textures)
        for_each_image(texture, [&](std::int32_t& image) { images.renumber(image); });
    for (Emitter& emitter : scene.emitters) {
        for_each_texture(emitter, [&](std::int32_t& texture) { textures.renumber(texture); });
        for_each_image(emitter, [&](std::int32_t& image) { images.renumber(image); });
    }
    return std::move(images).take();
}

}  // namespace treefarm
