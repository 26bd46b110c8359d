// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <map>

#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/texture_reader.h"

namespace treefarm::mitsuba {

/// Turns BSDF elements into materials of the scene; the same element always becomes the same material.
///
/// BSDFs around others (twosided, mask, bumpmap, normalmap, blendbsdf, mixturebsdf) flatten, in any order, into one
/// Material per element: what a Material cannot hold (two bump maps, bumps inside a blend) throws InputError or, when
/// lenient, is left out.
class MaterialReader {
  public:
    MaterialReader(Scene& scene, const SceneDocument& document, Diagnostics& diagnostics)
        : scene_(scene), document_(document), diagnostics_(diagnostics), textures_(scene, document, diagnostics) {}

    /// Index of the material. BSDFs that are not available throw InputError or, when lenient, become diffuse with
    /// reflectance 0.5.
    std::int32_t read(const XmlElement& bsdf);

    /// Index of the material of an element that stands in no file, which is kept.
    std::int32_t read_made(XmlElement bsdf);

    /// Index of what a shape without a BSDF gets: 0.5, or black if it is an emitter.
    std::int32_t read_default(bool on_emitter, const Location& where);

    /// The textures of the materials; emitters share them.
    TextureReader& textures() { return textures_; }

  private:
    /// A material as its element says, converted once: references can make a few lines stand for any number of BSDFs.
    const Material& convert(const XmlElement& bsdf);
    Material convert_new(const XmlElement& bsdf);
    Material convert_twosided(Properties& properties);
    Material convert_mask(Properties& properties);
    static void read_tilt(Properties& properties, NormalDetail& detail);
    Material convert_bump(Properties& properties);
    Material convert_normal_map(Properties& properties);
    Material convert_blend(Properties& properties);
    Material convert_mixture(Properties& properties);

    /// The only BSDF inside.
    Material convert_child(Properties& properties);
    /// The only texture inside, under any name; InputError if there is none.
    const XmlElement& texture_inside(Properties& properties, const char* what);
    void set_detail(Material& material, const NormalDetail& detail, const Properties& properties);
    Material blend(const FloatInput& weight, Material first, Material second, const Properties& properties);
    /// A material that a blend or coat holds: masks become blends with nothing.
    std::int32_t add_part(Material material);
    std::int32_t add(Material material);

    /// What a material is made of, its parts included.
    struct Summary {
        bool transmits = false;
        int leaves = 1;  ///< BSDFs that hold no others, and coats
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

}  // namespace treefarm::mitsuba
