// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <new>
#include <tuple>
#include <type_traits>
#include <vector>

#include "common/scene/model/scene.h"
#include "worker/shading/bsdf.h"
#include "worker/textures/texture_set.h"

namespace treefarm {

/// A surface hit, in the frame in which its BSDF is evaluated.
struct ShadingPoint : TexturePoint {
    Vec3 dp_du{1.0f, 0.0f, 0.0f}, dp_dv{0.0f, 1.0f, 0.0f};  ///< in the shading frame
    Vec3 wo{0.0f, 0.0f, 1.0f};                              ///< in the shading frame, wo.z > 0
    bool mirrored = false;                                  ///< the frame's normal is the reverse of the surface's
    bool flat = false;                                      ///< bump and normal maps are left out
};

/// Storage for the inputs that one BSDF keeps apart (BsdfNeeds::Kept), of any kind.
struct KeptInputs {
    static constexpr std::size_t kAlignment = 8;

    alignas(kAlignment) std::array<std::byte, kMostKept<MaterialKind>> bytes;

    template <class Inputs>
    const Inputs* keep(const Inputs& inputs) {
        static_assert(std::is_trivially_destructible_v<Inputs> && sizeof(Inputs) <= sizeof(bytes));
        static_assert(alignof(Inputs) <= kAlignment);
        return ::new (static_cast<void*>(bytes.data())) Inputs(inputs);
    }
};

/// Storage for the BSDFs of one hit, reused by a thread; it never grows.
class BsdfScratch {
  public:
    explicit BsdfScratch(std::size_t nodes = 0, std::size_t kept = 0) : nodes_(nodes), coats_(nodes), kept_(kept) {}

    void clear() { used_ = coats_used_ = kept_used_ = 0; }
    Bsdf& add() { return nodes_[used_++]; }
    RoughTransmittance& add_coat() { return coats_[coats_used_++]; }
    KeptInputs& add_kept() { return kept_[kept_used_++]; }

  private:
    std::vector<Bsdf> nodes_;
    std::vector<RoughTransmittance> coats_;
    std::vector<KeptInputs> kept_;
    std::size_t used_ = 0, coats_used_ = 0, kept_used_ = 0;
};

/// Builder of BSDFs from material descriptions: once for constant materials, at every hit for the others. Each kind of
/// material has a make_bsdf() in its own header, which receives a context that looks up its inputs
/// (BsdfBuilder::Context) and returns the BSDF.
class BsdfBuilder {
  public:
    /// Copies what it needs of the materials that shapes use. `textures` must outlive the builder. Throws RunError for
    /// a material made of more than kMaxNodes parts.
    BsdfBuilder(const Scene& scene, const TextureSet& textures);
    BsdfBuilder(const BsdfBuilder&) = delete;
    BsdfBuilder& operator=(const BsdfBuilder&) = delete;

    /// BSDF of one side of a constant material. Lives as long as the builder.
    const Bsdf* constant(std::int32_t material, bool back);

    /// BSDF of one side of a material at a point; lives until the scratch is cleared. The scratch must hold nodes() and
    /// kept().
    const Bsdf* at(std::int32_t material, bool back, const ShadingPoint& point, BsdfScratch& scratch) const;

    /// Whether the BSDF must be built at every hit, because of textures, tilted normals or tangents.
    bool varies(std::int32_t material) const { return facts_[static_cast<std::size_t>(material)].varies; }
    /// Whether at() needs more of the point than texture coordinates and wo.
    bool needs_tangents(std::int32_t material) const { return facts_[static_cast<std::size_t>(material)].tangents; }
    /// Image that at() is likely to read first: an index in TextureSet::textures(), or kNone.
    std::int32_t first_texture(std::int32_t material) const {
        return facts_[static_cast<std::size_t>(material)].texture;
    }
    /// Number of the material's parts that keep inputs apart (BsdfNeeds::Kept).
    std::size_t kept(std::int32_t material) const { return facts_[static_cast<std::size_t>(material)].kept; }
    /// Number of nodes that at() needs for the material.
    std::size_t nodes(std::int32_t material) const { return facts_[static_cast<std::size_t>(material)].nodes; }

    static constexpr std::size_t kMaxNodes = 256;

  private:
    /// Properties of a material that are equal at all points.
    struct MaterialFacts {
        bool varies = false;
        bool anisotropic = false;  ///< itself, not its parts
        bool tangents = false;     ///< it, or a part, has a frame of its own
        bool transmits = false;    ///< its back scatters by nature: glass, null, blends with them
        std::size_t nodes = 0, kept = 0;
        std::int32_t texture = kNone;                ///< texture that it most likely reads first
        const RoughTransmittance* coat = nullptr;    ///< of a rough coat of constant roughness
        const RoughTransmittances* coats = nullptr;  ///< of a rough coat of varying roughness
        float smooth_escapes = 1;                    ///< of smooth plastic: see coated_base
    };

    void find_facts(std::size_t material);
    void find_coat(const Roughness& roughness, float eta, MaterialFacts& facts);

    template <class Material, class Nodes>
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
    std::deque<KeptInputs> constant_kept_;
};

}  // namespace treefarm
