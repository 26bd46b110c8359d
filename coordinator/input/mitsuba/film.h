// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/setting.h"
#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/properties.h"
#include "coordinator/input/mitsuba/sensor.h"

namespace treefarm::mitsuba {

/// Reads <film type="hdrfilm">; without an element the film has 768 x 576 pixels; without a filter, a Gaussian of 0.5
/// pixels, as in Mitsuba. `wanted` replaces the size where it is not 0, and a crop window keeps its share of it.
/// `version` is the sensor's. A pixel format with alpha becomes a setting.
Film read_film(const XmlElement* film, const FilmSize& wanted, int version, std::vector<Setting>& settings,
               const SceneDocument& document, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
