// SPDX-License-Identifier: Apache-2.0
#include "common/plan/effect_table.h"

#include <utility>
#include <vector>

#include "common/config/effect_switches.h"
#include "common/scene/model/emitter.h"

namespace treefarm {
namespace {

constexpr const char* kNoMemory = "no memory";

/// Each kind of emitter is an effect.
void add_kinds(std::vector<EffectDescription>& rows, LightType type) {
    for_each_emitter_kind([&]<class Kind>() {
        constexpr const EmitterTraits& kTraits = Kind::kTraits;
        if (kTraits.type == type) rows.push_back({kTraits.effect, "light", kTraits.what, kTraits.when, kTraits.cost});
    });
}

std::vector<EffectDescription> light_rows() {
    std::vector<EffectDescription> rows = {
        {"next_event", "light", "emitters are sampled directly at every surface that is hit",
         "`integrator.next_event` is not never, and there are emitters",
         "a choice and a shadow ray per vertex; tables: see the emitters"},
        {"mis", "light", "next event and scattering are weighed against each other (Veach 1997)", "with next event",
         "no memory; a density per vertex"},
        {"kickstart", "light", "next event only in passes that start with fewer than 128 spp done",
         "`integrator.next_event` is kickstart", kNoMemory}};
    add_kinds(rows, LightType::area);
    rows.push_back({"textured_area", "light", "emission that a texture varies",
                    "an area emitter's radiance is a texture",
                    "a lookup where it is hit; the image counts with bitmaps"});
    rows.push_back({"delta_lights", "light", "emitters that no ray can hit",
                    "there are " + delta_light_names() + " emitters", "128 bytes per emitter"});
    add_kinds(rows, LightType::delta);
    rows.push_back({"environment", "light", "light from infinity", "there is a constant emitter or an environment map",
                    "see the two kinds"});
    add_kinds(rows, LightType::environment);
    return rows;
}

std::vector<EffectDescription> other_rows() {
    return {
        {"diffuse", "materials", "Lambertian reflection", "a material has such a lobe", kNoMemory},
        {"delta_reflection", "materials", "mirrors, smooth glass and coats", "a material has such a lobe", kNoMemory},
        {"microfacets", "materials", "rough metal, glass and coats (Walter et al. 2007)", "a material is rough",
         "no memory; sampling by visible normals"},
        {"anisotropy", "materials", "roughness that differs along and across",
         "a material's two roughnesses differ or are looked up apart", "tangents at every hit of a textured scene"},
        {"transmission", "materials", "light passes through dielectrics, refracted or straight",
         "a material is a dielectric, rough, smooth or thin", kNoMemory},
        {"coats", "materials", "a diffuse base under a dielectric coat", "a material is plastic", kNoMemory},
        {"rough_diffuse", "materials", "facets that are diffuse (Oren and Nayar 1994)", "a material is roughdiffuse",
         "no memory; some 30 operations per evaluation more than diffuse"},
        {"phong", "materials", "Phong's lobe over a diffuse base", "a material is phong", kNoMemory},
        {"principled", "materials", "Disney's principled BSDF (Burley 2012 and 2015)", "a material is principled",
         "128 bytes a material; up to five lobes per evaluation"},
        {"principled_thin", "materials", "Disney's principled BSDF of a thin sheet (Burley 2015)",
         "a material is principledthin", "128 bytes a material; up to four lobes per evaluation"},
        {"coatings", "materials", "a dielectric coat over another material (Weidlich and Wilkie 2007)",
         "a material is a coating or roughcoating", "two refractions more per evaluation of what is beneath"},
        {"ward", "materials", "Ward's anisotropic lobe over a diffuse base", "a material is ward", kNoMemory},
        {"blends", "materials", "two materials mixed", "a material is a blend", "both parts are evaluated"},
        {"null", "materials", "surfaces that are not there", "a material is null", "a ray continues"},
        {"twosided", "materials", "the back scatters, too", "a material is twosided", kNoMemory},
        {"textures", "materials", "colours, weights and roughness that are looked up",
         "a material that a shape uses names a texture", "8 bytes per vertex of the meshes that carry them"},
        {"bitmaps", "materials", "images as textures, bump, normal maps or masks", "a texture in use is a bitmap",
         "the images: 1 byte per channel and pixel, 4 for floats"},
        {"checkerboards", "materials", "squares of two colours", "a texture in use is a checkerboard", kNoMemory},
        {"bump", "materials", "shading normals tilted by a texture of displacements", "a material has a bump map",
         "three lookups per vertex"},
        {"normal_maps", "materials", "shading normals read from an image", "a material has a normal map",
         "a lookup per vertex"},

        {"masks", "shapes", "surfaces that are not met everywhere", "a shape's material has an opacity below 1",
         "a call and a lookup for every surface that a ray may meet"},
        {"triangles", "shapes", "meshes, rectangles and cubes", "a shape is a mesh",
         "its arrays: 12 bytes per triangle, 12 to 32 per vertex; hierarchy: 67 bytes per triangle"},
        {"smooth_normals", "shapes", "normals interpolated over triangles", "a mesh has normals",
         "12 bytes per vertex"},
        {"analytic_shapes", "shapes", "spheres, disks and cylinders without triangles", "a shape is one of them",
         "400 bytes each"},
        {"instances", "shapes", "groups of shapes placed several times", "a shape is an instance",
         "400 bytes each; a second level of hierarchy"},

        {"lens", "camera", "depth of field of a thin lens", "the sensor is a thin lens with an aperture",
         "no memory; two random numbers per path"},
        {"pixel_filter", "camera", "a wide box, tent, Gaussian, cubic or Lanczos filter, sampled",
         "the film's filter is not a box of one pixel", kNoMemory},

        {"guiding", "transport", "directions drawn from what earlier passes learned (Mueller et al. 2017)",
         "`guiding.type` is not none and there is more than one pass",
         "560 bytes per region and 8 per cell; a lookup per vertex"},
        {"views", "transport", "where rough surfaces were met, directions by where light goes, too (Cavus 2020)",
         "`guiding.type` is view or auto, a material is rough, and there is more than one pass",
         "32 bytes per view and 8 per cell, at most half of the regions' cells; a lookup more per vertex there"},
        {"recording", "transport", "paths teach the tree", "with guiding, in all passes but the last",
         "13 bytes per cell and 22 per region, 150 where the mixture is learned; a record per vertex"},
        {"roulette", "transport", "Russian roulette ends paths that carry little",
         "paths may be longer than `integrator.rr_depth`", kNoMemory},
        {"depth_limit", "transport", "paths end at a given length: light is lost", "`integrator.max_depth` is set",
         kNoMemory},
        {"strict_normals", "transport", "light that geometric and shading normal disagree about is dropped",
         "`integrator.strict_normals`", kNoMemory},
        {"hidden_emitters", "transport", "the camera does not see emitters", "`integrator.hide_emitters`", kNoMemory},

        {"media", "never", "fog, smoke and clouds", "", "", false},
        {"subsurface", "never", "light that wanders below surfaces", "", "", false},
        {"motion", "never", "motion blur", "", "", false},
        {"polarisation", "never", "polarised light", "", "", false},
        {"dispersion", "never", "refraction by wavelength", "", "", false},
    };
}

std::string switch_text(const EffectDescription& effect) {
    for (const EffectSwitch& known : effect_switches())
        if (known.name == effect.name) return "`effects." + effect.name + " = false`: " + known.replacement;
    for (const auto& [name, cure] : effects_without_switch())
        if (name == effect.name) return cure;
    return "";
}

}  // namespace

std::span<const EffectDescription> effect_table() {
    static const std::vector<EffectDescription> table = [] {
        std::vector<EffectDescription> rows = light_rows();
        for (EffectDescription& row : other_rows())
            rows.push_back(std::move(row));
        return rows;
    }();
    return table;
}

std::string delta_light_names() {
    std::vector<std::string> names;
    for_each_emitter_kind([&]<class Kind>() {
        if (Kind::kTraits.type == LightType::delta) names.push_back(Kind::kTraits.effect);
    });
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
    return text;
}

std::string effect_documentation() {
    std::string text = "| effect | what it is | on when | cost | off by |\n|---|---|---|---|---|\n";
    for (const EffectDescription& effect : effect_table())
        if (effect.simulated)
            text += "| `" + effect.name + "` | " + effect.what + " | " + effect.when + " | " + effect.cost + " | " +
                    switch_text(effect) + " |\n";
    text += "\nNever simulated:\n\n";
    for (const EffectDescription& effect : effect_table())
        if (!effect.simulated) text += "- `" + effect.name + "`: " + effect.what + "\n";
    return text;
}

}  // namespace treefarm
