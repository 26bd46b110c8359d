// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/properties.h"
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

/// Adds the sky with a large sun that Mitsuba 0.6 adds to a scene without emitters, with a warning.
void add_default_sky(const SceneDocument& document, Scene& scene, TextureReader& textures, Diagnostics& diagnostics);

/// Adds the emitters of <emitter type="sky">, "sun" or "sunsky": an image of the sky with the sun's disk in it, and a
/// directional emitter for a sun without extent. The sky is Hosek and Wilkie's. The sun is Preetham's in files of
/// version 0.x, as in Mitsuba 0.6, and Hosek and Wilkie's in later ones, as in Mitsuba 3.
void read_sky(Properties& properties, Scene& scene, TextureReader& textures);

}  // namespace treefarm::mitsuba
