#pragma once

#include "common/scene/scene.h"
#include "worker/geometry/ray.h"
#include "worker/integrator/pixel_filter.h"

namespace treefarm {

/// Rays of the pinhole camera through the pixel filter.
class CameraRays {
  public:
    CameraRays(const Camera& camera, const Film& film) : camera_(camera), film_(film), filter_(film) {}

    /// The ray of pixel (x, y), y down; random[0] and [1] place it on the filter. In double, since a long lens far away
    /// has neighbouring pixels closer together than floats near the film's corner.
    Ray generate(int x, int y, const Draw& random) const {
        const double sx = (x + 0.5 + double(filter_.sample(random[0]))) / film_.width;
        const double sy = (y + 0.5 + double(filter_.sample(random[1]))) / film_.height;
        const Imath::V3d d =
            Imath::V3d(camera_.corner) + sx * Imath::V3d(camera_.across) + sy * Imath::V3d(camera_.down);
        return {camera_.origin, Vec3(d * (1.0 / std::sqrt(d.dot(d))))};
    }

  private:
    Camera camera_;
    Film film_;
    FilterSampler filter_;
};

}  // namespace treefarm
