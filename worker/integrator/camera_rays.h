#pragma once

#include "common/base/build_options.h"
#include "common/base/random.h"
#include "common/math/warp.h"
#include "common/scene/scene.h"
#include "worker/geometry/ray.h"
#include "worker/integrator/pixel_filter.h"

namespace treefarm {

/// Rays of the camera through the pixel filter.
class CameraRays {
  public:
    CameraRays(const Camera& camera, const Film& film)
        : camera_(camera), film_(film), filter_(film), has_lens_(camera.has_lens()) {}

    /// The ray of pixel (x, y), y down, of a path.
    Ray generate(int x, int y, const PathKey& path) const {
        // The lens draws for itself, out of line: a pinhole then pays neither for its numbers nor for its registers.
        if (kHasLens && has_lens_) [[unlikely]]
            return through_lens(x, y, path);
        return pinhole(through_pixel(x, y, draw(path, 0, Stream::camera)));
    }

    /// The same from random numbers: [0] and [1] place the ray on the filter, [2] and [3] on the lens.
    Ray generate(int x, int y, const Draw& random) const {
        const Imath::V3d focus = through_pixel(x, y, random);
        return has_lens_ ? through_lens(focus, random) : pinhole(focus);
    }

    bool has_lens() const { return has_lens_; }

  private:
    /// From the camera to the plane of focus. In double, since a long lens far away has neighbouring pixels closer
    /// together than floats near the film's corner.
    Imath::V3d through_pixel(int x, int y, const Draw& random) const {
        const double sx = (x + 0.5 + double(filter_.sample(random[0]))) / film_.width;
        const double sy = (y + 0.5 + double(filter_.sample(random[1]))) / film_.height;
        return Imath::V3d(camera_.corner) + sx * Imath::V3d(camera_.across) + sy * Imath::V3d(camera_.down);
    }

    Ray pinhole(const Imath::V3d& focus) const {
        return {camera_.origin, Vec3(focus * (1.0 / std::sqrt(focus.dot(focus))))};
    }

    /// From a uniform point of the lens to where the pinhole's ray meets the plane of focus.
    Ray through_lens(const Imath::V3d& focus, const Draw& random) const {
        const Vec2 lens = square_to_disk({to_unit(random[2]), to_unit(random[3])});
        const Vec3 shift = camera_.lens_u * lens.x + camera_.lens_v * lens.y;
        const Imath::V3d d = focus - Imath::V3d(shift);
        return {camera_.origin + shift, Vec3(d * (1.0 / std::sqrt(d.dot(d))))};
    }

    [[gnu::noinline]] Ray through_lens(int x, int y, const PathKey& path) const {
        return generate(x, y, draw(path, 0, Stream::camera));
    }

    Camera camera_;
    Film film_;
    FilterSampler filter_;
    bool has_lens_;
};

}  // namespace treefarm
