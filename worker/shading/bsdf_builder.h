// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <tuple>
#include <vector>

#include "common/scene/model/scene.h"
#include "worker/shading/bsdf.h"
#include "worker/textures/texture_set.h"

namespace treefarm {

/// Where a surface was hit, in the frame that its BSDF is wanted in.
struct ShadingPoint : TexturePoint {
    Vec3 dp_du{1.0f, 0.0f, 0.0f}, dp_dv{0.0f, 1.0f, 0.0f};  ///< in the shading frame
    Vec3 wo{0.0f, 0.0f, 1.0f};                              ///< in the shading frame, wo.z > 0
    bool mirrored = false;                                  ///< the frame's normal is the reverse of the surface's
};

/// Storage for the BSDFs of one hit: a thread keeps it; it never grows.
class BsdfScratch {
  public:
    explicit BsdfScratch(std::size_t nodes = 0, std::size_t principled = 0)
        : nodes_(nodes), coats_(nodes), principled_(principled) {}

    void clear() { used_ = coats_used_ = principled_used_ = 0; }
    Bsdf& add() { return nodes_[used_++]; }
    RoughTransmittance& add_coat() { return coats_[coats_used_++]; }
    PrincipledInputs& add_principled() { return principled_[principled_used_++]; }

  private:
    std::vector<Bsdf> nodes_;
    std::vector<RoughTransmittance> coats_;
    std::vector<PrincipledInputs> principled_;
    std::size_t used_ = 0, coats_used_ = 0, principled_used_ = 0;
};

/// Turns descriptions into BSDFs: once for those that are the same everywhere, at every hit for the others. What a kind
/// of material becomes, make_bsdf() in its own header says: it is given a context that looks up its inputs
/// (BsdfBuilder::Context) and returns what scatters there.
class BsdfBuilder {
  public:
    /// Takes what it needs of the scene's materials that shapes use. `textures` must outlive the builder. Throws
    /// RunError for a material made of more than kMaxNodes parts.
    BsdfBuilder(const Scene& scene, const TextureSet& textures);
    BsdfBuilder(const BsdfBuilder&) = delete;
    BsdfBuilder& operator=(const BsdfBuilder&) = delete;

    /// One side of a material that does not vary. The result lives as long as the builder.
    const Bsdf* constant(std::int32_t material, bool back);

    /// One side of a material at a point; the result lives until the scratch is cleared, which must hold nodes() and
    /// principled().
    const Bsdf* at(std::int32_t material, bool back, const ShadingPoint& point, BsdfScratch& scratch) const;

    /// Whether it must be built at every hit: textures, tilted normals, tangents.
    bool varies(std::int32_t material) const { return facts_[static_cast<std::size_t>(material)].varies; }
    /// Whether at() needs more of the point than texture coordinates and wo.
    bool needs_tangents(std::int32_t material) const { return facts_[static_cast<std::size_t>(material)].tangents; }
    /// The image that at() is likely to look up first: an index in TextureSet::textures(), or kNone.
    std::int32_t first_texture(std::int32_t material) const {
        return facts_[static_cast<std::size_t>(material)].texture;
    }
    /// Principled materials that at() looks up for it.
    std::size_t principled(std::int32_t material) const {
        return facts_[static_cast<std::size_t>(material)].principled;
    }
    /// Nodes that at() needs for it.
    std::size_t nodes(std::int32_t material) const { return facts_[static_cast<std::size_t>(material)].nodes; }

    static constexpr std::size_t kMaxNodes = 256;

  private:
    /// What is known of a material before any point of it.
    struct MaterialFacts {
        bool varies = false;
        bool anisotropic = false;  ///< itself, not what it is made of
        bool tangents = false;     ///< it, or what it is made of, has a frame of its own
        bool transmits = false;    ///< its back scatters by nature: glass, nothing, blends with them
        std::size_t nodes = 0, principled = 0;
        std::int32_t texture = kNone;                ///< that it most likely reads first
        const RoughTransmittance* coat = nullptr;    ///< a rough coat of one roughness
        const RoughTransmittances* coats = nullptr;  ///< a rough coat whose roughness varies
        float smooth_escapes = 1;                    ///< smooth plastic: see coated_base
    };

    void find_facts(std::size_t material);
    void find_coat(const Roughness& roughness, float eta, MaterialFacts& facts);

    template <class Nodes>
    struct Context;

    template <class Nodes>
    const Bsdf* side(std::int32_t material, bool back, const ShadingPoint& point, Nodes& nodes) const;
    template <class Nodes>
    const Bsdf* described(std::int32_t material, bool back, const ShadingPoint& point, Nodes& nodes) const;
    template <class Nodes>
    Bsdf leaf(std::int32_t material, bool back, const ShadingPoint& point, Nodes& nodes) const;

    Rgb color(const ColorInput& input, const ShadingPoint& point, float most) const;
    Microfacet facets(const Roughness& roughness, const ShadingPoint& point) const;
    Vec3 tilted_normal(const NormalDetail& detail, const ShadingPoint& point) const;

    std::vector<Material> materials_;
    const TextureSet* textures_;
    std::vector<MaterialFacts> facts_;
    std::map<std::tuple<bool, float, float>, RoughTransmittance> coats_;
    std::map<std::tuple<bool, float>, RoughTransmittances> varying_coats_;
    std::deque<Bsdf> constants_;
    std::deque<PrincipledInputs> constant_principled_;
};

}  // namespace treefarm
