// SPDX-License-Identifier: Apache-2.0
#include "worker/shading/bsdf_builder.h"

#include <concepts>
#include <limits>

#include "common/base/error.h"
#include "common/math/frame.h"
#include "common/scene/uses/material_traits.h"
#include "common/scene/uses/material_uses.h"

namespace treefarm {
namespace {

/// Storage of the BSDFs of constant materials.
struct ConstantNodes {
    std::deque<Bsdf>& bsdfs;
    std::deque<KeptInputs>& kept;

    Bsdf& add() { return bsdfs.emplace_back(); }
    KeptInputs& add_kept() { return kept.emplace_back(); }
    RoughTransmittance& add_coat() { throw RunError("a constant material has a coat whose roughness varies"); }
};

/// A frame about n with s along `along`, which may be degenerate.
OrientedBsdf oriented(const Bsdf* inner, const Vec3& n, const Vec3& along) {
    const Vec3 across = cross(n, along);
    const float length2 = dot(across, across);
    OrientedBsdf bsdf{inner, {}, {}, n, 0.0f};
    if (length2 > 1e-12f * dot(along, along) && length2 > 1e-30f) {  // below that the root has lost its digits
        bsdf.t = across * (1.0f / std::sqrt(length2));
        bsdf.s = cross(bsdf.t, n);
    } else {
        const Frame frame(n);
        bsdf.s = frame.s;
        bsdf.t = frame.t;
    }
    return bsdf;
}

/// A shading point transformed into the frame of an oriented BSDF.
ShadingPoint seen_in(const OrientedBsdf& frame, const ShadingPoint& point) {
    return {
        point,     frame.to_inner(point.dp_du), frame.to_inner(point.dp_dv), frame.to_inner(point.wo), point.mirrored,
        point.flat};
}

/// Texture of a material's first input: its main colour, or a blend's weight.
std::int32_t first_texture_of(const Material& material) {
    std::int32_t first = kNone;
    for_each_input(material, [&](const auto& input) {
        if (first == kNone) first = input.texture;
    });
    return first;
}

float clamped(float x, float most) {
    return std::min(most, std::max(0.0f, x));
}

/// Upper bound of a material's factors.
float largest_factor(const Material& material) {
    return material.keeps_factors() ? std::numeric_limits<float>::max() : 1.0f;
}

}  // namespace

BsdfBuilder::BsdfBuilder(const Scene& scene, const TextureSet& textures)
    : materials_(scene.materials), textures_(&textures), facts_(scene.materials.size()) {
    const std::vector<bool> used = used_materials(scene);
    for (std::size_t i = 0; i < materials_.size(); ++i)
        if (used[i]) find_facts(i);
}

void BsdfBuilder::find_facts(std::size_t index) {
    const Material& material = materials_[index];
    const MaterialTraits traits = own_traits(material);
    MaterialFacts facts;
    facts.varies = traits.needs_surface_detail();
    facts.anisotropic = traits.anisotropic;
    facts.tangents = traits.anisotropic || material.detail.any();
    facts.texture = first_texture_of(material);
    facts.transmits = traits.lobes.transmits();
    std::visit([&]<class Kind>(const Kind&) { facts.kept = std::is_void_v<typename BsdfNeeds<Kind>::Kept> ? 0 : 1; },
               material.bsdf);
    // One node for the material, and one for each frame that it adds.
    facts.nodes = 1 + (material.detail.any() ? 1 : 0) + (traits.anisotropic ? 1 : 0);
    // Parts precede the materials that they belong to: their facts are known.
    for_each_part(material, [&](const std::int32_t& part) {
        const MaterialFacts& of_part = facts_[static_cast<std::size_t>(part)];
        facts.varies |= of_part.varies;
        facts.tangents |= of_part.tangents;
        if (&part == &material.back) {  // replaces the front
            facts.nodes = std::max(facts.nodes, of_part.nodes);
            facts.kept = std::max(facts.kept, of_part.kept);
            return;
        }
        if (facts.texture == kNone) facts.texture = of_part.texture;
        facts.transmits |= of_part.transmits;
        facts.nodes += of_part.nodes;
        facts.kept += of_part.kept;
    });
    if (facts.nodes > kMaxNodes)
        throw RunError(material.where.text() + ": material \"" + material.name + "\" is made of more than " +
                       std::to_string(kMaxNodes) + " parts, too many for every hit; blend fewer materials");
    std::visit(
        [&]<class Kind>(const Kind& kind) {
            if constexpr (BsdfNeeds<Kind>::kCoat) find_coat(kind.roughness, kind.eta, facts);
        },
        material.bsdf);
    facts_[index] = facts;
}

void BsdfBuilder::find_coat(const Roughness& r, float eta, MaterialFacts& facts) {
    const bool ggx = r.distribution == Microfacets::ggx;
    if (r.smooth()) {
        const float inverse = 1.0f / (eta * eta);
        facts.smooth_escapes = smooth_diffuse_transmittance(eta) * inverse;
    } else if (r.alpha_u.varies()) {
        facts.coats = &varying_coats_.try_emplace({ggx, eta}, ggx, eta).first->second;
    } else {
        const Microfacet facets = this->facets(r, {});
        facts.coat = &coats_.try_emplace({ggx, facets.alpha_u, eta}, facets, eta).first->second;
    }
}

const Bsdf* BsdfBuilder::constant(std::int32_t material, bool back) {
    ConstantNodes nodes{constants_, constant_kept_};
    return side(material, back, {}, nodes);
}

const Bsdf* BsdfBuilder::at(std::int32_t material, bool back, const ShadingPoint& point, BsdfScratch& scratch) const {
    scratch.clear();
    return side(material, back, point, scratch);
}

template <class Nodes>
const Bsdf* BsdfBuilder::side(std::int32_t index, bool back, const ShadingPoint& point, Nodes& nodes) const {
    const Material& material = materials_[static_cast<std::size_t>(index)];
    if (!back || facts_[static_cast<std::size_t>(index)].transmits) return described(index, back, point, nodes);
    if (material.twosided)
        return material.back == kNone ? described(index, false, point, nodes)
                                      : side(material.back, false, point, nodes);
    // Parts may be two-sided even if the whole is not.
    const bool of_parts = std::visit(
        [](const auto& kind) {
            return requires {
                kind.kSidesOfParts;
            };
        },
        material.bsdf);
    if (of_parts) return described(index, true, point, nodes);
    // A node from the scratch still holds the BSDF of an earlier hit.
    Bsdf& black = nodes.add();
    black = Bsdf{};
    return &black;
}

template <class Nodes>
const Bsdf* BsdfBuilder::described(std::int32_t index, bool back, const ShadingPoint& point, Nodes& nodes) const {
    const Material& material = materials_[static_cast<std::size_t>(index)];
    Bsdf& outer = nodes.add();
    // From the outside in: the tilted frame, the frame along the tangent, the scattering BSDF.
    Bsdf* slot = &outer;
    ShadingPoint inside = point;
    const auto orient = [&](const Vec3& normal, bool shadowed) {
        Bsdf& inner = nodes.add();
        OrientedBsdf frame = oriented(&inner, normal, inside.dp_du);
        if (shadowed) frame.shadow_alpha2 = OrientedBsdf::shadow_alpha2_of(normal);
        slot->kind = frame;
        slot = &inner;
        inside = seen_in(frame, inside);
    };
    if (material.detail.any() && !point.flat) orient(tilted_normal(material.detail, point), material.detail.shadowed);
    if (facts_[static_cast<std::size_t>(index)].anisotropic) orient(Vec3(0.0f, 0.0f, 1.0f), false);
    *slot = leaf(index, back, inside, nodes);
    return &outer;
}

/// Context of a kind's make_bsdf(): a surface point's data and inputs.
template <class Material, class Nodes>
struct BsdfBuilder::Context {
    using Result = Bsdf;

    const BsdfBuilder& builder;
    const MaterialFacts& facts;
    const bool back;
    const ShadingPoint& point;
    Nodes& nodes;
    const float largest;  ///< upper bound of colours

    Rgb color(const ColorInput& input) const { return builder.color(input, point, largest); }
    Rgb amount(const ColorInput& input) const { return builder.color(input, point, std::numeric_limits<float>::max()); }
    float number(const FloatInput& input) const { return builder.textures_->eval(input, point); }
    float fraction(const FloatInput& input) const { return clamped(builder.textures_->eval(input, point), 1.0f); }
    Microfacet facets(const Roughness& roughness) const { return builder.facets(roughness, point); }
    const Bsdf* part(std::int32_t material) const { return builder.side(material, back, point, nodes); }
    template <class Inputs>
    requires std::same_as<Inputs, typename BsdfNeeds<Material>::Kept>
    const Inputs* keep(const Inputs& inputs) const { return nodes.add_kept().keep(inputs); }
    float smooth_escapes() const requires BsdfNeeds<Material>::kCoat { return facts.smooth_escapes; }
    const RoughTransmittance* coat(const Microfacet& rough) const requires BsdfNeeds<Material>::kCoat {
        if (!facts.coats) return facts.coat;
        RoughTransmittance& mixed = nodes.add_coat();
        mixed = facts.coats->at(rough.alpha_u);
        return &mixed;
    }
};

template <class Nodes>
Bsdf BsdfBuilder::leaf(std::int32_t index, bool back, const ShadingPoint& point, Nodes& nodes) const {
    const Material& described = materials_[static_cast<std::size_t>(index)];
    const MaterialFacts& facts = facts_[static_cast<std::size_t>(index)];
    return std::visit(
        [&]<class Kind>(const Kind& material) {
            const Context<Kind, Nodes> context{*this, facts, back, point, nodes, largest_factor(described)};
            return make_bsdf(material, context);
        },
        described.bsdf);
}

Rgb BsdfBuilder::color(const ColorInput& input, const ShadingPoint& point, float most) const {
    const Rgb c = textures_->eval(input, point);
    return {clamped(c.x, most), clamped(c.y, most), clamped(c.z, most)};
}

Microfacet BsdfBuilder::facets(const Roughness& roughness, const ShadingPoint& point) const {
    const auto alpha = [&](const FloatInput& input) {
        return std::clamp(textures_->eval(input, point), Microfacet::kMinAlpha, Microfacet::kMaxAlpha);
    };
    return {roughness.distribution == Microfacets::ggx, alpha(roughness.alpha_u), alpha(roughness.alpha_v)};
}

/// Tilted normal in the shading frame, on the side of wo. A normal that faces away from wo would make the surface
/// black, so it is turned about the surface's own normal, or bent towards wo until it faces wo.
Vec3 BsdfBuilder::tilted_normal(const NormalDetail& detail, const ShadingPoint& point) const {
    const Vec3 up(0.0f, 0.0f, 1.0f);
    // Both maps are relative to the surface's own side; its back gets the tilt of the same world normal.
    const float side = point.mirrored ? -1.0f : 1.0f;
    Vec3 n = up;
    if (detail.normal_map != kNone) {
        const Rgb c = textures_->color(detail.normal_map, point) * detail.normal_scale;
        const Vec3 local(2.0f * c.x - 1.0f, 2.0f * c.y - 1.0f, 2.0f * c.z - 1.0f);
        const OrientedBsdf tangents = oriented(nullptr, up * side, point.dp_du);
        const Vec3 mapped = tangents.to_outer(local) * side;
        if (mapped.z > 0.0f) n = normalize(mapped);
    }
    if (detail.bump != kNone) {
        const Vec2 slope = textures_->gradient(detail.bump, point) * detail.bump_scale;
        const Vec3 outward = n * side;
        // Tangents of the displaced surface, as in Mitsuba 0.6: without the term of the normal's derivative.
        const Vec3 du = point.dp_du + outward * (slope.x - dot(outward, point.dp_du));
        const Vec3 dv = point.dp_dv + outward * (slope.y - dot(outward, point.dp_dv));
        Vec3 bumped = cross(du, dv);
        if (bumped.z < 0.0f) bumped = -bumped;
        const float length2 = dot(bumped, bumped);
        if (length2 > 0.0f && std::isfinite(length2)) n = bumped * (1.0f / std::sqrt(length2));
    }
    if (detail.flip_invalid && !(dot(n, point.wo) > 0.0f)) n = {-n.x, -n.y, n.z};
    // The turned normal faces wo, unless wo is grazing.
    const float facing = dot(n, point.wo), least = std::min(detail.flip_invalid ? 1e-4f : 0.01f, 0.5f * point.wo.z);
    return facing < least ? normalize(n + point.wo * (least - facing)) : n;
}

}  // namespace treefarm
