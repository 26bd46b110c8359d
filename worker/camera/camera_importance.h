// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/random.h"
#include "common/scene/model/scene.h"
#include "worker/camera/pixel_filter.h"

namespace treefarm {

/// Projection of a scene point onto the film, as seen from one point of the lens.
struct FilmConnection {
    bool seen = false;     ///< false: the point is behind the camera, or outside any film
    double x = 0, y = 0;   ///< film position in pixels of the whole film; may be outside it
    Vec3 target{0.0f};     ///< the point on the lens, or the origin of the parallel ray
    Vec3 direction{0.0f};  ///< unit, from the scene point to `target`
    /// Camera importance, per area: a surface element dA that faces the camera and sends radiance L to it contributes L
    /// g dA to the film, uniformly over the film, whose measure is 1.
    double g = 0;
    /// Density of the camera ray per steradian, for a uniform film position; 0 for an orthographic camera.
    double direction_pdf = 0;
};

/// Camera importance and film position of scene points (docs/design/transport.md): the inverse of CameraRays. In
/// double, as CameraRays.
class CameraImportance {
  public:
    CameraImportance(const Camera& camera, const Film& film);

    /// Projection of `p` from the lens point that `lens` [0] and [1] choose uniformly.
    FilmConnection connect(const Vec3& p, const Draw& lens) const {
        if (panoramic_) return panorama(p);
        return is_parallel_ ? parallel(p) : through_lens(p, lens);
    }

  private:
    using Vec3d = Imath::V3d;

    FilmConnection through_lens(const Vec3& p, const Draw& lens) const;
    FilmConnection parallel(const Vec3& p) const;
    FilmConnection panorama(const Vec3& p) const;
    /// Sets the film position of a point of the film's plane, given relative to the film's corner.
    void set_position(FilmConnection& connection, const Vec3d& from_corner) const;

    Vec3d origin_, corner_, across_, down_;
    Vec3d normal_;  ///< across x down
    Vec3d parallel_;
    Vec3 lens_u_, lens_v_;
    double width_, height_;  ///< of the whole film, pixels
    bool has_lens_, is_parallel_, panoramic_;
};

/// A pixel that takes a splat.
struct PixelPick {
    bool found = false;
    std::uint32_t pixel = 0;  ///< index among the rendered pixels
    double weight = 0;        ///< sum of all pixels' filters at the position, times film area over window area
};

/// Choice of the pixel that takes a splat: each pixel with its filter's value over the sum of all filters' values at
/// that film position; the sum is the weight. For filters without negative lobes.
class PixelPicker {
  public:
    explicit PixelPicker(const Film& film, bool panoramic);

    /// Pixel for the position (x, y) on the whole film, in pixels. random [0] chooses the column, [1] the row, [2]
    /// among the positions that are one direction of a panorama.
    PixelPick pick(double x, double y, const Draw& random) const;
    /// Whether any pixel's filter is nonzero at a film position.
    bool reaches(double x, double y) const;

  private:
    /// A pixel coordinate along one axis, and the sum of all filters at the position.
    struct Axis {
        int pixel = 0;
        double sum = 0;
    };
    /// Pixel coordinate in [begin, end) along one axis.
    Axis pick_along(double x, int begin, int end, std::uint32_t random) const;
    PixelPick pick_point(double x, double y, const Draw& random) const;
    PixelPick pick_of_panorama(double x, double y, const Draw& random) const;

    FilterSampler filter_;
    int x0_, y0_, x1_, y1_;  ///< the window on the whole film
    double whole_width_, whole_height_;
    /// pixels of the film over pixels of the window: the number of light paths is per window pixel
    double per_window_;
    bool panoramic_;
};

}  // namespace treefarm
