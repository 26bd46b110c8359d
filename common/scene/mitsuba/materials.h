#pragma once

#include <map>

#include "common/scene/mitsuba/properties.h"
#include "common/scene/scene.h"

namespace treefarm::mitsuba {

/// Turns BSDF elements into materials of the scene; the same element always becomes the same material.
class MaterialReader {
  public:
    MaterialReader(Scene& scene, const SceneDocument& document, Diagnostics& diagnostics)
        : scene_(scene), document_(document), diagnostics_(diagnostics) {}

    /// Index of the material. `diffuse` and `twosided` are available; others throw InputError or, when lenient, become
    /// a diffuse material of reflectance 0.5.
    std::int32_t read(const XmlElement& bsdf);

    /// Index of what a shape without a BSDF gets: 0.5, or black if it is an emitter.
    std::int32_t read_default(bool on_emitter, const Location& where);

  private:
    Material convert(const XmlElement& bsdf);
    Material convert_diffuse(Properties& properties);
    Material convert_twosided(Properties& properties);
    std::int32_t add(Material material);

    Scene& scene_;
    const SceneDocument& document_;
    Diagnostics& diagnostics_;
    std::map<const XmlElement*, std::int32_t> known_;
    std::int32_t default_[2] = {kNone, kNone};
};

}  // namespace treefarm::mitsuba
