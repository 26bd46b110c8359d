// SPDX-License-Identifier: Apache-2.0
#include "worker/shading/material_set.h"

namespace treefarm {

MaterialSet::MaterialSet(const Scene& scene, const TextureSet& textures) : builder_(scene, textures) {
    std::vector<std::array<Side, 2>> of_material(scene.materials.size());
    std::vector<bool> known(scene.materials.size(), false);
    sides_.resize(2 * scene.shapes.size());
    for (std::size_t shape = 0; shape < scene.shapes.size(); ++shape) {
        const std::int32_t material = scene.shapes[shape].material;
        if (material == kNone) continue;
        const auto index = static_cast<std::size_t>(material);
        for (const bool back : {false, true}) {
            Side& side = of_material[index][back];
            if (!known[index]) {
                if (builder_.varies(material)) {
                    side.material = material;
                    scratch_nodes_ = std::max(scratch_nodes_, builder_.nodes(material));
                    scratch_kept_ = std::max(scratch_kept_, builder_.kept(material));
                } else {
                    side.bsdf = builder_.constant(material, back);
                    side.lobes = lobes_of(*side.bsdf);
                    if (side.lobes == 0) side.bsdf = nullptr;
                }
            }
            sides_[2 * shape + (back ? 1 : 0)] = side;
        }
        known[index] = true;
    }
}

}  // namespace treefarm
