// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "common/base/random.h"
#include "common/math/warp.h"
#include "common/scene/model/scene.h"
#include "worker/camera/pixel_filter.h"
#include "worker/geometry/ray.h"

namespace treefarm {

/// Rays of the camera through the pixel filter.
class CameraRays {
  public:
    CameraRays(const Camera& camera, const Film& film)
        : camera_(camera),
          filter_(film),
          x0_(film.crop.x),
          y0_(film.crop.y),
          width_(film.whole_width()),
          height_(film.whole_height()),
          has_lens_(camera.has_lens()),
          is_perspective_(!camera.is_orthographic() && !camera.panoramic) {}

    /// Camera ray of a path through pixel (x, y) of the window; y points down.
    template <Numbers N = PathKey>
    Ray generate(int x, int y, const N& path) const {
        // Lens sampling is out of line: a pinhole pays neither for its random numbers nor for its registers.
        if (has_lens_) [[unlikely]]
            return through_lens(x, y, path);
        if (!is_perspective_) [[unlikely]]
            return elsewhere(x, y, path);
        return pinhole(through_pixel(x, y, draw(path, 0, Stream::camera)));
    }

    /// Camera ray from random numbers: [0] and [1] choose the point of the filter, [2] and [3] that of the lens.
    Ray generate(int x, int y, const Draw& random) const {
        if (camera_.panoramic) return panoramic(x, y, random);
        const Imath::V3d focus = through_pixel(x, y, random);
        if (camera_.is_orthographic()) return orthographic(focus);
        return has_lens_ ? through_lens(focus, random) : pinhole(focus);
    }

    /// Weight of a path's sample: 1 unless the filter has negative lobes.
    template <Numbers N = PathKey>
    float weight(const N& path) const {
        const Draw random = draw(path, 0, Stream::camera);
        return filter_.weight(random[0]) * filter_.weight(random[1]);
    }

    bool has_lens() const { return has_lens_; }
    const Camera& camera() const { return camera_; }

  private:
    struct FilmPoint {
        double x, y;  ///< film position: [0, 1] over the whole film, beyond it by up to the filter radius
    };

    static Ray ray(const Vec3& origin, const Vec3& direction) {
        Ray ray{origin, direction};
        ray.of_camera = true;
        return ray;
    }

    FilmPoint film_point(int x, int y, const Draw& random) const {
        return {(x + x0_ + 0.5 + double(filter_.sample(random[0]))) / width_,
                (y + y0_ + 0.5 + double(filter_.sample(random[1]))) / height_};
    }

    /// Vector from the camera to the focal plane. In double: seen by a long lens far from the origin, neighbouring
    /// pixels are closer together than floats near the film's corner.
    Imath::V3d through_pixel(int x, int y, const Draw& random) const {
        const auto [sx, sy] = film_point(x, y, random);
        return Imath::V3d(camera_.corner) + sx * Imath::V3d(camera_.across) + sy * Imath::V3d(camera_.down);
    }

    Ray pinhole(const Imath::V3d& focus) const {
        return ray(camera_.origin, Vec3(focus * (1.0 / std::sqrt(focus.dot(focus)))));
    }

    /// Ray from a uniform point of the lens to the point where the pinhole ray meets the focal plane.
    Ray through_lens(const Imath::V3d& focus, const Draw& random) const {
        const Vec2 lens = square_to_disk({to_unit(random[2]), to_unit(random[3])});
        const Vec3 shift = camera_.lens_u * lens.x + camera_.lens_v * lens.y;
        const Imath::V3d d = focus - Imath::V3d(shift);
        return ray(camera_.origin + shift, Vec3(d * (1.0 / std::sqrt(d.dot(d)))));
    }

    [[gnu::noinline]] Ray through_lens(int x, int y, const Numbers auto& path) const {
        return generate(x, y, draw(path, 0, Stream::camera));
    }

    Ray orthographic(const Imath::V3d& point) const {
        return ray(Vec3(Imath::V3d(camera_.origin) + point), camera_.parallel);
    }

    Ray panoramic(int x, int y, const Draw& random) const {
        auto [u, v] = film_point(x, y, random);
        // The filter reaches over the film's edge: there a panorama continues beyond the pole, or at the other side.
        if (v < 0.0 || v > 1.0) {
            v = v < 0.0 ? -v : 2.0 - v;
            u += 0.5;
        }
        u -= std::floor(u);
        return ray(camera_.origin, camera_.panorama_direction(static_cast<float>(u), static_cast<float>(v)));
    }

    /// Ray of an orthographic or panoramic camera.
    [[gnu::noinline]] Ray elsewhere(int x, int y, const Numbers auto& path) const {
        return generate(x, y, draw(path, 0, Stream::camera));
    }

    Camera camera_;
    FilterSampler filter_;
    int x0_, y0_, width_, height_;  ///< of the window; of the whole film
    bool has_lens_, is_perspective_;
};

}  // namespace treefarm
