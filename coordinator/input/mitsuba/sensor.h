// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/setting.h"
#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Film size that a job requests; 0: as in the scene.
struct FilmSize {
    int width = 0, height = 0;
};

/// Reads <sensor type="perspective">, "thinlens" or "orthographic" with its film, filter and sampler into scene.camera
/// and scene.film; properties of the sampler become settings.
void read_sensor(const XmlElement& sensor, const FilmSize& wanted, Scene& scene, std::vector<Setting>& settings,
                 const SceneDocument& document, Diagnostics& diagnostics);

/// Camera with a horizontal field of view (degrees) on a film of the given aspect, width over height. Camera space is
/// Mitsuba's: the camera looks along z, y is up, x is to the left. The principal point is offset by a share of the
/// film.
Camera make_camera(const Matrix& to_world, double horizontal_fov, double aspect, double principal_x,
                   double principal_y);

/// Reads <film type="hdrfilm">; without an element the film has 768 x 576 pixels; without a filter, a Gaussian of 0.5
/// pixels, as in Mitsuba. `wanted` replaces the size where it is not 0, and a crop window keeps its share of it.
/// `version` is the sensor's. A pixel format with alpha becomes a setting.
Film read_film(const XmlElement* film, const FilmSize& wanted, int version, std::vector<Setting>& settings,
               const SceneDocument& document, Diagnostics& diagnostics);

/// The sensor to render: the one with the id `wanted`, or with this number among all, from 0 on. If `wanted` is empty,
/// the first, or in files of version 0.x the last, as in Mitsuba, with a note if there are more. nullptr if the scene
/// has none, with a warning: set_default_camera() follows. Mitsuba 3 refuses that, so in its files it throws InputError
/// unless lenient.
const XmlElement* choose_sensor(Properties& scene, const std::string& wanted, Diagnostics& diagnostics);

/// Adds the camera that Mitsuba 0.6 and 2 add to a scene without a sensor: it looks along z, with a field of view of 45
/// degrees, from where the scene's extent in x and y (2 and 3: in x, y and z) fills it. The film must be there.
void set_default_camera(int version, Scene& scene);

}  // namespace treefarm::mitsuba
