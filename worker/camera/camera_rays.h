// SPDX-License-Identifier: Apache-2.0
#pragma once

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
          is_orthographic_(camera.is_orthographic()) {}

    /// The ray of pixel (x, y) of the window, y down, of a path.
    Ray generate(int x, int y, const PathKey& path) const {
        // The lens draws for itself, out of line: a pinhole then pays neither for its numbers nor for its registers.
        if (has_lens_) [[unlikely]]
            return through_lens(x, y, path);
        if (is_orthographic_) [[unlikely]]
            return orthographic(x, y, path);
        return pinhole(through_pixel(x, y, draw(path, 0, Stream::camera)));
    }

    /// A camera ray from random numbers: [0] and [1] place it on the filter, [2] and [3] on the lens.
    Ray generate(int x, int y, const Draw& random) const {
        const Imath::V3d focus = through_pixel(x, y, random);
        if (is_orthographic_) return orthographic(focus);
        return has_lens_ ? through_lens(focus, random) : pinhole(focus);
    }

    /// Weight of a path's sample: 1, but for filters with negative lobes.
    float weight(const PathKey& path) const {
        const Draw random = draw(path, 0, Stream::camera);
        return filter_.weight(random[0]) * filter_.weight(random[1]);
    }

    bool has_lens() const { return has_lens_; }

  private:
    /// Vector from the camera to the plane of focus. In double, since a long lens far away has neighbouring pixels
    /// closer together than floats near the film's corner.
    Imath::V3d through_pixel(int x, int y, const Draw& random) const {
        const double sx = (x + x0_ + 0.5 + double(filter_.sample(random[0]))) / width_;
        const double sy = (y + y0_ + 0.5 + double(filter_.sample(random[1]))) / height_;
        return Imath::V3d(camera_.corner) + sx * Imath::V3d(camera_.across) + sy * Imath::V3d(camera_.down);
    }

    Ray pinhole(const Imath::V3d& focus) const {
        return {camera_.origin, Vec3(focus * (1.0 / std::sqrt(focus.dot(focus))))};
    }

    /// Ray from a uniform point of the lens to where the pinhole's ray meets the plane of focus.
    Ray through_lens(const Imath::V3d& focus, const Draw& random) const {
        const Vec2 lens = square_to_disk({to_unit(random[2]), to_unit(random[3])});
        const Vec3 shift = camera_.lens_u * lens.x + camera_.lens_v * lens.y;
        const Imath::V3d d = focus - Imath::V3d(shift);
        return {camera_.origin + shift, Vec3(d * (1.0 / std::sqrt(d.dot(d))))};
    }

    [[gnu::noinline]] Ray through_lens(int x, int y, const PathKey& path) const {
        return generate(x, y, draw(path, 0, Stream::camera));
    }

    Ray orthographic(const Imath::V3d& point) const {
        return {Vec3(Imath::V3d(camera_.origin) + point), camera_.parallel};
    }

    [[gnu::noinline]] Ray orthographic(int x, int y, const PathKey& path) const {
        return generate(x, y, draw(path, 0, Stream::camera));
    }

    Camera camera_;
    FilterSampler filter_;
    int x0_, y0_, width_, height_;  ///< of the window; of the whole film
    bool has_lens_, is_orthographic_;
};

}  // namespace treefarm
