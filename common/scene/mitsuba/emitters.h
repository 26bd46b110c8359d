#pragma once

#include "common/scene/mitsuba/properties.h"
#include "common/scene/scene.h"

namespace treefarm::mitsuba {

/// Adds the area emitter of shape number `shape`. Other emitters in a shape throw InputError, or are skipped when
/// lenient.
void read_area_emitter(const XmlElement& emitter, std::int32_t shape, Scene& scene, const SceneDocument& document,
                       Diagnostics& diagnostics);

/// Adds an emitter that belongs to no shape: `constant` is available.
void read_environment(const XmlElement& emitter, Scene& scene, const SceneDocument& document, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
