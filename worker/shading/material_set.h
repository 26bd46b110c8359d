// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/shading/bsdf_builder.h"

namespace treefarm {

/// Materials of a scene's shapes, prepared for the path walk. Constant materials are built once; the others are looked
/// up at the hit. Immutable and thread-safe.
class MaterialSet {
  public:
    /// One side of a shape's surface.
    struct Side {
        const Bsdf* bsdf = nullptr;     ///< nullptr: see `material`
        std::int32_t material = kNone;  ///< a varying material, for look_up() at every hit; kNone: black
        LobeBits lobes = 0;             ///< of `bsdf`
    };

    /// `textures` must outlive the set. Throws as BsdfBuilder.
    MaterialSet(const Scene& scene, const TextureSet& textures);

    const Side& side(std::uint32_t shape, bool back) const { return sides_[2 * shape + (back ? 1 : 0)]; }

    /// Whether look_up() needs more of the point than texture coordinates and wo.
    bool needs_tangents(std::int32_t material) const { return builder_.needs_tangents(material); }
    /// Whether any material varies.
    bool varies() const { return scratch_nodes_ != 0; }
    /// Texture that look_up() is likely to read first; kNone: none.
    std::int32_t first_texture(std::int32_t material) const { return builder_.first_texture(material); }
    /// BSDF of a varying material at a point.
    const Bsdf* look_up(std::int32_t material, bool back, const ShadingPoint& point, BsdfScratch& scratch) const {
        return builder_.at(material, back, point, scratch);
    }
    /// Scratch large enough for every material of the scene.
    BsdfScratch make_scratch() const { return BsdfScratch(scratch_nodes_, scratch_kept_); }

  private:
    BsdfBuilder builder_;
    std::vector<Side> sides_;  ///< front and back of each shape
    std::size_t scratch_nodes_ = 0, scratch_kept_ = 0;
};

}  // namespace treefarm
