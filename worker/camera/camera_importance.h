// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/random.h"
#include "common/scene/model/scene.h"
#include "worker/camera/pixel_filter.h"

namespace treefarm {

/// A point of the scene as the camera sees it from one point of its lens.
struct FilmConnection {
    bool seen = false;     ///< false: it lies behind the camera; no film is so large
    double x = 0, y = 0;   ///< where it is on the whole film, in pixels; may lie beside it
    Vec3 target{0.0f};     ///< the point on the lens, or where the parallel ray starts
    Vec3 direction{0.0f};  ///< unit, from the point to there
    /// Camera importance: a point that faces the camera and sends radiance L to it brings L g dA to the film, uniform
    /// over the film, whose measure is 1. Per area.
    double g = 0;
    /// Density of the ray from the camera per steradian, for a uniform film position; 0 of an orthographic one.
    double direction_pdf = 0;
};

/// Where on the film points of the scene are, and what light from there is worth (docs/design/transport.md): the
/// reverse of CameraRays. In double, as those are.
class CameraImportance {
  public:
    CameraImportance(const Camera& camera, const Film& film);

    /// `lens` [0] and [1] choose the point of the lens, uniformly.
    FilmConnection connect(const Vec3& p, const Draw& lens) const {
        if (panoramic_) return panorama(p);
        return is_parallel_ ? parallel(p) : through_lens(p, lens);
    }

  private:
    using Vec3d = Imath::V3d;

    FilmConnection through_lens(const Vec3& p, const Draw& lens) const;
    FilmConnection parallel(const Vec3& p) const;
    FilmConnection panorama(const Vec3& p) const;
    /// Places a point of the film's plane, given from the film's corner.
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
    std::uint32_t pixel = 0;  ///< among those that are rendered
    double weight = 0;        ///< of the filters of all pixels together, and of the film over the window
};

/// Which pixel takes light that arrives at a point of the film: each with the probability of its filter there, of all
/// filters', whose sum is the weight. For filters without negative lobes.
class PixelPicker {
  public:
    explicit PixelPicker(const Film& film, bool panoramic);

    /// (x, y) on the whole film, in pixels; random [0] chooses the column, [1] the row, [2] among places of a panorama
    /// that are the same point.
    PixelPick pick(double x, double y, const Draw& random) const;
    /// Whether a pixel's filter reaches that place.
    bool reaches(double x, double y) const;

  private:
    /// A pixel along one axis, and the sum of all filters there.
    struct Axis {
        int pixel = 0;
        double sum = 0;
    };
    /// A pixel among [begin, end) along one axis.
    Axis pick_along(double x, int begin, int end, std::uint32_t random) const;
    PixelPick pick_point(double x, double y, const Draw& random) const;
    PixelPick pick_of_panorama(double x, double y, const Draw& random) const;

    FilterSampler filter_;
    int x0_, y0_, x1_, y1_;  ///< the window on the whole film
    double whole_width_, whole_height_;
    double per_window_;  ///< pixels of the film over those of the window: light paths are counted by these
    bool panoramic_;
};

}  // namespace treefarm
