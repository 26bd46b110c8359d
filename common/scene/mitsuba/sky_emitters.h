#pragma once

#include "common/scene/mitsuba/properties.h"
#include "common/scene/scene.h"

namespace treefarm::mitsuba {

/// Adds the emitters of <emitter type="sky">, "sun" or "sunsky": an image of the sky with the sun's disk in it, and for
/// a sun without extent a directional emitter. The model is Preetham's, not Mitsuba's (Hosek and Wilkie's), and a
/// warning says so.
void read_sky(Properties& properties, Scene& scene, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
