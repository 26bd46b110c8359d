// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/texture_reader.h"

namespace treefarm::mitsuba {

/// Adds the area emitter of shape number `shape`. Other emitters in a shape throw InputError, or are skipped when
/// lenient.
void read_area_emitter(const XmlElement& emitter, std::int32_t shape, Scene& scene, TextureReader& textures,
                       const SceneDocument& document, Diagnostics& diagnostics);

/// Adds an emitter that belongs to no shape: point, spot, directional, constant, envmap, sky, sun or sunsky. Others
/// throw InputError, or are skipped when lenient.
void read_emitter(const XmlElement& emitter, Scene& scene, TextureReader& textures, const SceneDocument& document,
                  Diagnostics& diagnostics);

/// An environment whose axes are turned by the property to_world; anything but a rotation or a mirror throws
/// InputError.
EnvironmentEmitter read_environment_axes(Properties& properties);

}  // namespace treefarm::mitsuba
