#pragma once

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

    /// The ray of pixel (x, y), y down; random[0] and [1] place it on the filter, [2] and [3] on the lens. In double,
    /// since a long lens far away has neighbouring pixels closer together than floats near the film's corner.
    Ray generate(int x, int y, const Draw& random) const {
        const double sx = (x + 0.5 + double(filter_.sample(random[0]))) / film_.width;
        const double sy = (y + 0.5 + double(filter_.sample(random[1]))) / film_.height;
        const Imath::V3d d =
            Imath::V3d(camera_.corner) + sx * Imath::V3d(camera_.across) + sy * Imath::V3d(camera_.down);
        if (has_lens_) [[unlikely]]
            return through_lens(d, random);
        return {camera_.origin, Vec3(d * (1.0 / std::sqrt(d.dot(d))))};
    }

  private:
    /// From a uniform point of the lens to where the pinhole's ray meets the plane of focus.
    Ray through_lens(const Imath::V3d& focus, const Draw& random) const {
        const Vec2 lens = square_to_disk({to_unit(random[2]), to_unit(random[3])});
        const Vec3 shift = camera_.lens_u * lens.x + camera_.lens_v * lens.y;
        const Imath::V3d d = focus - Imath::V3d(shift);
        return {camera_.origin + shift, Vec3(d * (1.0 / std::sqrt(d.dot(d))))};
    }

    Camera camera_;
    Film film_;
    FilterSampler filter_;
    bool has_lens_;
};

}  // namespace treefarm
