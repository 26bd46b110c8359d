#include "worker/shading/bsdf_builder.h"

#include <limits>
#include <type_traits>

#include "common/base/build_options.h"
#include "common/base/error.h"
#include "common/math/frame.h"
#include "common/scene/material_traits.h"

namespace treefarm {
namespace {

/// Where BSDFs of constant materials are kept.
struct ConstantNodes {
    std::deque<Bsdf>& bsdfs;

    Bsdf& add() { return bsdfs.emplace_back(); }
    RoughTransmittance& add_coat() { throw RunError("a constant material has a coat whose roughness varies"); }
};

/// Nearer to 1, refraction bends by less than floats tell; the half vector of a refraction would be rounding error.
bool refracts(float eta) {
    return std::abs(eta - 1.0f) > 1e-4f;
}

/// A frame about n whose s follows `along`, which may be degenerate.
OrientedBsdf oriented(const Bsdf* inner, const Vec3& n, const Vec3& along) {
    const Vec3 across = cross(n, along);
    const float length2 = dot(across, across);
    OrientedBsdf bsdf{inner, {}, {}, n};
    if (length2 > 1e-12f * dot(along, along) && length2 > 1e-30f) {  // below, its root has lost digits
        bsdf.t = across * (1.0f / std::sqrt(length2));
        bsdf.s = cross(bsdf.t, n);
    } else {
        const Frame frame(n);
        bsdf.s = frame.s;
        bsdf.t = frame.t;
    }
    return bsdf;
}

/// The point as seen in the frame of an oriented BSDF.
ShadingPoint seen_in(const OrientedBsdf& frame, const ShadingPoint& point) {
    return {point.uv, frame.to_inner(point.dp_du), frame.to_inner(point.dp_dv), frame.to_inner(point.wo),
            point.mirrored};
}

/// The texture of a material's main colour, or of what a blend is mixed by.
std::int32_t color_texture(const Material& material) {
    if (const auto* diffuse = std::get_if<DiffuseMaterial>(&material.bsdf)) return diffuse->reflectance.texture;
    if (const auto* plastic = std::get_if<PlasticMaterial>(&material.bsdf)) return plastic->diffuse_reflectance.texture;
    if (const auto* blend = std::get_if<BlendMaterial>(&material.bsdf)) return blend->weight.texture;
    if (const auto* metal = std::get_if<ConductorMaterial>(&material.bsdf)) return metal->specular_reflectance.texture;
    return kNone;
}

float clamped(float x, float most) {
    return std::min(most, std::max(0.0f, x));
}

/// The most that a factor of a material may be: interreflection below a coat knows no more than 1.
float largest_factor(const Material& material) {
    const auto* plastic = std::get_if<PlasticMaterial>(&material.bsdf);
    return material.unlimited && !(plastic && plastic->nonlinear) ? std::numeric_limits<float>::max() : 1.0f;
}

}  // namespace

BsdfBuilder::BsdfBuilder(const Scene& scene, const TextureSet& textures)
    : materials_(scene.materials), textures_(&textures), notes_(scene.materials.size()) {
    const std::vector<bool> used = used_materials(scene);
    for (std::size_t i = 0; i < materials_.size(); ++i)
        if (used[i]) note(i);
}

void BsdfBuilder::note(std::size_t index) {
    const Material& material = materials_[index];
    const MaterialTraits traits = own_traits(material);
    Notes notes;
    notes.varies = traits.needs_surface_detail();
    notes.anisotropic = traits.anisotropic;
    notes.tangents = traits.anisotropic || material.detail.any();
    notes.texture = color_texture(material);
    notes.transmits = traits.lobes.transmits();
    // Its own node, and one for each frame of its own.
    notes.nodes = 1 + (material.detail.any() ? 1 : 0) + (traits.anisotropic ? 1 : 0);
    // Parts stand below what they are part of: theirs are known.
    if (const auto* blend = std::get_if<BlendMaterial>(&material.bsdf))
        for (const std::int32_t part : {blend->first, blend->second}) {
            const Notes& of_part = notes_[static_cast<std::size_t>(part)];
            notes.varies |= of_part.varies;
            notes.tangents |= of_part.tangents;
            if (notes.texture == kNone) notes.texture = of_part.texture;
            notes.transmits |= of_part.transmits;
            notes.nodes += of_part.nodes;
        }
    if (material.twosided && material.back != kNone) {
        const Notes& of_back = notes_[static_cast<std::size_t>(material.back)];
        notes.varies |= of_back.varies;
        notes.tangents |= of_back.tangents;
        notes.nodes = std::max(notes.nodes, of_back.nodes);
    }
    if (notes.nodes > kMaxNodes)
        throw RunError(material.where.text() + ": material \"" + material.name + "\" is made of more than " +
                       std::to_string(kMaxNodes) + " parts, too many for every hit; blend fewer materials");
    if (const auto* plastic = std::get_if<PlasticMaterial>(&material.bsdf)) note_coat(*plastic, notes);
    notes_[index] = notes;
}

void BsdfBuilder::note_coat(const PlasticMaterial& plastic, Notes& notes) {
    const Roughness& r = plastic.roughness;
    const bool ggx = r.distribution == Microfacets::ggx;
    if (r.smooth()) {
        const float inverse = 1.0f / (plastic.eta * plastic.eta);
        notes.smooth_escapes = smooth_diffuse_transmittance(plastic.eta) * inverse;
    } else if (r.alpha_u.varies()) {
        notes.coats = &varying_coats_.try_emplace({ggx, plastic.eta}, ggx, plastic.eta).first->second;
    } else {
        const Microfacet facets = this->facets(r, {});
        notes.coat = &coats_.try_emplace({ggx, facets.alpha_u, plastic.eta}, facets, plastic.eta).first->second;
    }
}

const Bsdf* BsdfBuilder::constant(std::int32_t material, bool back) {
    ConstantNodes nodes{constants_};
    return side(material, back, {}, nodes);
}

const Bsdf* BsdfBuilder::at(std::int32_t material, bool back, const ShadingPoint& point, BsdfScratch& scratch) const {
    scratch.clear();
    return side(material, back, point, scratch);
}

template <class Nodes>
const Bsdf* BsdfBuilder::side(std::int32_t index, bool back, const ShadingPoint& point, Nodes& nodes) const {
    const Material& material = materials_[static_cast<std::size_t>(index)];
    if (!back || notes_[static_cast<std::size_t>(index)].transmits) return described(index, back, point, nodes);
    if (material.twosided)
        return material.back == kNone ? described(index, false, point, nodes)
                                      : side(material.back, false, point, nodes);
    // The parts of a blend may be twosided where it is not.
    if (std::holds_alternative<BlendMaterial>(material.bsdf)) return described(index, true, point, nodes);
    // What a scratch hands out still holds the BSDF of an earlier hit.
    Bsdf& black = nodes.add();
    black = Bsdf{};
    return &black;
}

template <class Nodes>
const Bsdf* BsdfBuilder::described(std::int32_t index, bool back, const ShadingPoint& point, Nodes& nodes) const {
    const Material& material = materials_[static_cast<std::size_t>(index)];
    Bsdf& outer = nodes.add();
    // From the outside in: the tilted frame, the frame along its tangent, what scatters in it.
    Bsdf* slot = &outer;
    ShadingPoint inside = point;
    const auto orient = [&](const Vec3& normal) {
        Bsdf& inner = nodes.add();
        const OrientedBsdf frame = oriented(&inner, normal, inside.dp_du);
        slot->kind = frame;
        slot = &inner;
        inside = seen_in(frame, inside);
    };
    if (kHasBump && material.detail.any()) orient(tilted_normal(material.detail, point));
    if (notes_[static_cast<std::size_t>(index)].anisotropic) orient(Vec3(0.0f, 0.0f, 1.0f));
    *slot = leaf(index, back, inside, nodes);
    return &outer;
}

template <class Nodes>
Bsdf BsdfBuilder::leaf(std::int32_t index, bool back, const ShadingPoint& point, Nodes& nodes) const {
    const float most = largest_factor(materials_[static_cast<std::size_t>(index)]);
    const auto factor = [&](const ColorInput& input) { return color(input, point, most); };
    const auto of = [&](const auto& m) -> Bsdf {
        using Kind = std::decay_t<decltype(m)>;
        if constexpr (std::is_same_v<Kind, DiffuseMaterial>) {
            const Rgb albedo = factor(m.reflectance);
            return is_black(albedo) ? Bsdf{} : Bsdf{DiffuseBsdf{albedo}};
        } else if constexpr (std::is_same_v<Kind, ConductorMaterial>) {
            const Rgb reflectance = factor(m.specular_reflectance);
            if (m.roughness.smooth()) return {ConductorBsdf{m.eta, m.k, reflectance}};
            return {RoughConductorBsdf{m.eta, m.k, reflectance, facets(m.roughness, point)}};
        } else if constexpr (std::is_same_v<Kind, DielectricMaterial>) {
            if constexpr (!kHasTransmission) return {};
            const Rgb reflectance = factor(m.specular_reflectance), transmittance = factor(m.specular_transmittance);
            if (!refracts(m.eta)) return {NullBsdf{transmittance}};
            const float eta = back ? 1.0f / m.eta : m.eta;
            if (m.roughness.smooth()) return {DielectricBsdf{eta, reflectance, transmittance}};
            return {RoughDielectricBsdf{eta, reflectance, transmittance, facets(m.roughness, point)}};
        } else if constexpr (std::is_same_v<Kind, ThinDielectricMaterial>) {
            if constexpr (!kHasTransmission) return {};
            return {ThinDielectricBsdf{m.eta, factor(m.specular_reflectance), factor(m.specular_transmittance)}};
        } else if constexpr (std::is_same_v<Kind, PlasticMaterial>) {
            const Notes& notes = notes_[static_cast<std::size_t>(index)];
            const Rgb diffuse = factor(m.diffuse_reflectance), specular = factor(m.specular_reflectance);
            const float coat = luminance(specular), base = luminance(diffuse);
            if (!(coat + base > 0.0f)) return {};
            CoatedBase coated{Rgb(0.0f), coat / (coat + base)};
            if (m.roughness.smooth()) {
                coated.base = coated_base(diffuse, notes.smooth_escapes, m.eta, m.nonlinear);
                return {PlasticBsdf{m.eta, specular, coated}};
            }
            const Microfacet rough = facets(m.roughness, point);
            const RoughTransmittance* transmittance = notes.coat;
            if (notes.coats) {
                RoughTransmittance& mixed = nodes.add_coat();
                mixed = notes.coats->at(rough.alpha_u);
                transmittance = &mixed;
            }
            coated.base = coated_base(diffuse, transmittance->escapes(m.single_return), m.eta, m.nonlinear);
            return {RoughPlasticBsdf{m.eta, specular, coated, rough, transmittance}};
        } else if constexpr (std::is_same_v<Kind, BlendMaterial>) {
            const float weight = clamped(textures_->eval(m.weight, point.uv), 1.0f);
            return {BlendBsdf{weight, side(m.first, back, point, nodes), side(m.second, back, point, nodes)}};
        } else {
            static_assert(std::is_same_v<Kind, NullMaterial>);
            return {NullBsdf{}};
        }
    };
    return std::visit(of, materials_[static_cast<std::size_t>(index)].bsdf);
}

Rgb BsdfBuilder::color(const ColorInput& input, const ShadingPoint& point, float most) const {
    const Rgb c = textures_->eval(input, point.uv);
    return {clamped(c.x, most), clamped(c.y, most), clamped(c.z, most)};
}

Microfacet BsdfBuilder::facets(const Roughness& roughness, const ShadingPoint& point) const {
    const auto alpha = [&](const FloatInput& input) {
        return std::clamp(textures_->eval(input, point.uv), Microfacet::kMinAlpha, Microfacet::kMaxAlpha);
    };
    return {roughness.distribution == Microfacets::ggx, alpha(roughness.alpha_u), alpha(roughness.alpha_v)};
}

/// The tilted normal in the shading frame, on the side of wo: where it would face away from wo the surface would be
/// black, so it is bent towards wo until it does not.
Vec3 BsdfBuilder::tilted_normal(const NormalDetail& detail, const ShadingPoint& point) const {
    const Vec3 up(0.0f, 0.0f, 1.0f);
    // Both maps know the surface's own side; on its back the tilt is that of the same world normal.
    const float side = point.mirrored ? -1.0f : 1.0f;
    Vec3 n = up;
    if (detail.normal_map != kNone) {
        const Rgb c = textures_->color(detail.normal_map, point.uv);
        const Vec3 local(2.0f * c.x - 1.0f, 2.0f * c.y - 1.0f, 2.0f * c.z - 1.0f);
        const OrientedBsdf tangents = oriented(nullptr, up * side, point.dp_du);
        const Vec3 mapped = tangents.to_outer(local) * side;
        if (mapped.z > 0.0f) n = normalize(mapped);
    }
    if (detail.bump != kNone) {
        const Vec2 slope = textures_->gradient(detail.bump, point.uv) * detail.bump_scale;
        const Vec3 outward = n * side;
        // The displaced surface's tangents, as in Mitsuba 0.6: without the term in the change of the normal.
        const Vec3 du = point.dp_du + outward * (slope.x - dot(outward, point.dp_du));
        const Vec3 dv = point.dp_dv + outward * (slope.y - dot(outward, point.dp_dv));
        Vec3 bumped = cross(du, dv);
        if (bumped.z < 0.0f) bumped = -bumped;
        const float length2 = dot(bumped, bumped);
        if (length2 > 0.0f && std::isfinite(length2)) n = bumped * (1.0f / std::sqrt(length2));
    }
    const float facing = dot(n, point.wo), least = std::min(0.01f, 0.5f * point.wo.z);
    return facing < least ? normalize(n + point.wo * (least - facing)) : n;
}

}  // namespace treefarm
