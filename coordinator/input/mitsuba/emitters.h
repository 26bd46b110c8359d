// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/texture_reader.h"

namespace treefarm::mitsuba {

/// Adds the area emitter of shape number `shape`. Other emitters in a shape throw InputError, or are skipped when
/// lenient.
void read_area_emitter(const XmlElement& emitter, std::int32_t shape, Scene& scene, TextureReader& textures,
                       const SceneDocument& document, Diagnostics& diagnostics);

/// Adds an emitter outside of shapes: point, spot, directional, constant, envmap, sky, sun or sunsky. Others throw
/// InputError, or are skipped when lenient.
void read_emitter(const XmlElement& emitter, Scene& scene, TextureReader& textures, const SceneDocument& document,
                  Diagnostics& diagnostics);

/// Environment with the axes of the property to_world. Throws InputError unless it is a rotation or a reflection.
EnvironmentEmitter read_environment_axes(Properties& properties);

}  // namespace treefarm::mitsuba
