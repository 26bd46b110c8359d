// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "common/scene/model/material.h"
#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/texture_reader.h"

namespace treefarm::mitsuba {

/// Turns BSDF elements into materials of the scene; equal elements become the same material.
///
/// BSDFs around others (twosided, mask, bumpmap, normalmap, blendbsdf, mixturebsdf) are flattened, in any order, into
/// one Material per element. Combinations that a Material cannot hold (two bump maps, bumps inside a blend) throw
/// InputError or, when lenient, are dropped.
class MaterialReader {
  public:
    MaterialReader(Scene& scene, const SceneDocument& document, Diagnostics& diagnostics)
        : scene_(scene), document_(document), diagnostics_(diagnostics), textures_(scene, document, diagnostics) {}

    /// Index of the material. Unsupported BSDFs throw InputError or, when lenient, become diffuse with reflectance 0.5.
    std::int32_t read(const XmlElement& bsdf);

    /// Index of the material of an element made by the program, which is kept.
    std::int32_t read_made(XmlElement bsdf);

    /// Index of the material of a shape without BSDF: reflectance 0.5, or black for an emitter.
    std::int32_t read_default(bool on_emitter, const Location& where);

    /// Textures of the materials, shared with emitters.
    TextureReader& textures() { return textures_; }

  private:
    /// The material of an element, converted once: by references, a few lines can stand for any number of BSDFs.
    const Material& convert(const XmlElement& bsdf);
    Material convert_new(const XmlElement& bsdf);
    Material convert_twosided(Properties& properties);
    Material convert_mask(Properties& properties);
    static void read_tilt(Properties& properties, NormalDetail& detail);
    Material convert_bump(Properties& properties);
    Material convert_normal_map(Properties& properties);
    Material convert_blend(Properties& properties);
    Material convert_mixture(Properties& properties);

    /// Material of the only BSDF inside.
    Material convert_child(Properties& properties);
    /// The only texture inside, under any name. Throws InputError if there is none.
    const XmlElement& texture_inside(Properties& properties, const char* what);
    void set_detail(Material& material, const NormalDetail& detail, const Properties& properties);
    Material blend(const FloatInput& weight, Material first, Material second, const Properties& properties);
    /// Adds a material as a part of a blend or coat: masks become blends with null.
    std::int32_t add_part(Material material);
    std::int32_t add(Material material);

    /// Properties of a material and its parts.
    struct Summary {
        bool transmits = false;
        int leaves = 1;  ///< BSDFs without parts, and coats
    };
    Summary summary_of(const Material& material) const;
    bool transmits(const Material& material) const { return summary_of(material).transmits; }

    Scene& scene_;
    const SceneDocument& document_;
    Diagnostics& diagnostics_;
    TextureReader textures_;
    std::list<XmlElement> made_;
    std::map<const XmlElement*, std::int32_t> known_;
    std::map<const XmlElement*, Material> converted_;
    std::vector<Summary> summaries_;  ///< of each material of the scene
    std::int32_t default_[2] = {kNone, kNone};
};

/// Reads a BSDF that is a kind of surface, with the defaults of the format's version; a coating is returned without its
/// coated material. Empty for other types.
std::optional<decltype(Material::bsdf)> read_surface_bsdf(Properties& properties, TextureReader& textures,
                                                          const SceneDocument& document, Diagnostics& diagnostics);

/// Types that read_surface_bsdf() supports.
std::vector<std::string_view> surface_bsdf_names();

}  // namespace treefarm::mitsuba
