// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/camera/camera_importance.h"
#include "worker/geometry/hit.h"
#include "worker/geometry/ray.h"

namespace treefarm {

/// Film and lens to which light paths are connected.
struct Sensor {
    CameraImportance importance;
    PixelPicker pixels;
    double
        per_window;  ///< pixels of the whole film over those that are rendered: rays of the camera are as much denser

    Sensor(const Camera& camera, const Film& film)
        : importance(camera, film),
          pixels(film, camera.panoramic),
          per_window(static_cast<double>(film.whole_width()) * film.whole_height() /
                     static_cast<double>(film.pixel_count())) {}
};

/// Shadow ray from a surface to the lens.
inline Ray ray_to_lens(const Hit& hit, const FilmConnection& to) {
    Ray ray{offset_origin(hit, to.direction), Vec3(0.0f), 1.0f, true};
    ray.direction = to.target - ray.origin;
    // Closer than the offset: no occluder fits between.
    if (!(dot(ray.direction, to.direction) > 0.0f)) ray.length = -1.0f;
    return ray;
}

}  // namespace treefarm
