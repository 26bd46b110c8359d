// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>

#include "common/config/effects/row.h"

namespace treefarm {

inline constexpr NoSwitch kChangeMaterials = instead("change the scene's materials");

inline constexpr auto kMaterialEffects = std::tuple(
    effect(
        {"diffuse", "materials", "Lambertian reflection", "a material has such a lobe", "no memory"},
        [](const auto& find) {
            return find.materials("material with a diffuse lobe", [](const auto& m) { return m.lobes.diffuse; });
        },
        kChangeMaterials),
    effect(
        {"delta_reflection", "materials", "mirrors, smooth glass and coats", "a material has such a lobe", "no memory"},
        [](const auto& find) {
            return find.materials("smooth material", [](const auto& m) { return m.lobes.delta_reflection; });
        },
        kChangeMaterials),
    effect(
        {"microfacets", "materials", "rough metal, glass and coats (Walter et al. 2007)", "a material is rough",
         "no memory; sampling by visible normals"},
        [](const auto& find) { return find.materials("rough material", [](const auto& m) { return m.microfacets; }); },
        kChangeMaterials),
    effect(
        {"anisotropy", "materials", "roughness that differs along and across",
         "a material's two roughnesses differ or are looked up apart", "tangents at every hit of a textured scene"},
        [](const auto& find) {
            return find.materials("anisotropic material", [](const auto& m) { return m.anisotropic; });
        },
        replaced(6, "roughness is the same along and across", [](auto& scene) { scene.anisotropy(); })),
    effect(
        {"transmission", "materials", "light passes through surfaces: refracted, straight or scattered",
         "a material is a dielectric, rough, smooth or thin, a principled one that transmits, difftrans or hk",
         "no memory"},
        [](const auto& find) {
            return find.materials("transmitting material", [](const auto& m) {
                return m.lobes.glossy_transmission || m.lobes.delta_transmission;
            });
        },
        replaced(5, "surfaces only reflect; what they would let through is lost",
                 [](auto& scene) { scene.transmission(); })),
    effect(
        {"coats", "materials", "a diffuse base under a dielectric coat", "a material is plastic", "no memory"},
        [](const auto& find) { return find.materials("plastic", [](const auto& m) { return m.coated; }); },
        kChangeMaterials),
    effect_of_kind({"rough_diffuse", "materials", "facets that are diffuse (Oren and Nayar 1994)",
                    "a material is roughdiffuse", "no memory; some 30 operations per evaluation more than diffuse"},
                   EffectFamily::materials, kChangeMaterials),
    effect_of_kind({"phong", "materials", "Phong's lobe over a diffuse base", "a material is phong", "no memory"},
                   EffectFamily::materials, kChangeMaterials),
    effect_of_kind({"principled", "materials", "Disney's principled BSDF (Burley 2012 and 2015)",
                    "a material is principled", "128 bytes a material; up to five lobes per evaluation"},
                   EffectFamily::materials, kChangeMaterials),
    effect_of_kind({"principled_thin", "materials", "Disney's principled BSDF of a thin sheet (Burley 2015)",
                    "a material is principledthin", "128 bytes a material; up to four lobes per evaluation"},
                   EffectFamily::materials, kChangeMaterials),
    effect_of_kind(
        {"coatings", "materials", "a dielectric coat over another material (Weidlich and Wilkie 2007)",
         "a material is a coating or roughcoating", "two refractions more per evaluation of what is beneath"},
        EffectFamily::materials, kChangeMaterials),
    effect_of_kind(
        {"ward", "materials", "Ward's anisotropic lobe over a diffuse base", "a material is ward", "no memory"},
        EffectFamily::materials, kChangeMaterials),
    effect_of_kind({"thin_layers", "materials", "single scattering in a layer (Hanrahan and Krueger 1993)",
                    "a material is hk", "no memory; nine exponentials per evaluation"},
                   EffectFamily::materials, kChangeMaterials),
    effect(
        {"blends", "materials", "two materials mixed", "a material is a blend", "both parts are evaluated"},
        [](const auto& find) { return find.materials("blend", [](const auto& m) { return m.blended; }); },
        kChangeMaterials),
    effect(
        {"null", "materials", "surfaces that are not there", "a material is null", "a ray continues"},
        [](const auto& find) { return find.materials("null material", [](const auto& m) { return m.lobes.null; }); },
        kChangeMaterials),
    effect(
        {"twosided", "materials", "the back scatters, too", "a material is twosided", "no memory"},
        [](const auto& find) { return find.materials("twosided material", [](const auto& m) { return m.twosided; }); },
        kChangeMaterials),

    effect(
        {"textures", "materials", "colours, weights and roughness that are looked up",
         "a material that a shape uses names a texture", "8 bytes per vertex of the meshes that carry them"},
        [](const auto& find) { return find.textures(); },
        replaced(1, "materials have the mean of each texture", [](auto& scene) { scene.textures(); })),
    effect_of_kind({"bitmaps", "materials", "images as textures, bump, normal maps or masks",
                    "a texture in use is a bitmap", "the images: 1 byte per channel and pixel, 4 for floats"},
                   EffectFamily::textures, part_of("textures")),
    effect_of_kind(
        {"checkerboards", "materials", "squares of two colours", "a texture in use is a checkerboard", "no memory"},
        EffectFamily::textures, part_of("textures")),
    effect_of_kind({"grids", "materials", "lines of one colour on another", "a texture in use is a grid", "no memory"},
                   EffectFamily::textures, part_of("textures")),
    effect_of_kind({"wireframes", "materials", "edges of triangles in another colour than their inside",
                    "a texture in use is a wireframe", "no memory"},
                   EffectFamily::textures, part_of("textures")),
    effect_of_kind({"mesh_attributes", "materials", "colours and numbers that meshes bring along",
                    "a texture in use is a mesh attribute", "12 bytes per vertex or triangle of meshes that use it"},
                   EffectFamily::textures, part_of("textures")),
    effect(
        {"bump", "materials", "shading normals tilted by a texture of displacements", "a material has a bump map",
         "three lookups per vertex"},
        [](const auto& find) { return find.materials("bumpy material", [](const auto& m) { return m.bumped; }); },
        replaced(3, "bumpy surfaces are smooth", [](auto& scene) { scene.bump(); })),
    effect(
        {"normal_maps", "materials", "shading normals read from an image", "a material has a normal map",
         "a lookup per vertex"},
        [](const auto& find) {
            return find.materials("material with a normal map", [](const auto& m) { return m.normal_mapped; });
        },
        replaced(4, "normals are the geometry's", [](auto& scene) { scene.normal_maps(); })));

}  // namespace treefarm
