#pragma once

#include <cstdint>
#include <vector>

#include "common/base/random.h"
#include "common/scene/emitter.h"
#include "worker/textures/texture_set.h"

namespace treefarm {

/// A distant sphere of radiance from an image, and how to sample it.
///
/// Radiance is interpolated between texel centres; u repeats, v ends at the poles. The density over (u, v) interpolates
/// luminance * sin(theta) of the same texels, so it is continuous, follows the radiance within texels, and vanishes
/// only where the radiance does. Between texel centres lie patches: a row of them is drawn, then one of its columns,
/// both from tables, then a place in it. Rows run from pole to pole: one more than texels, the outer two half as high,
/// or without height where texels' centres lie on the poles.
///
/// Memory: 4 bytes for each patch besides the image itself, 0.5 MB for 512 x 256, 134 MB for 8192 x 4096.
class EnvironmentMap {
  public:
    /// Texels that are negative or not finite count as black. `image` must outlive it; `emitter.scale` is at least 0.
    EnvironmentMap(const EnvironmentEmitter& emitter, const TextureImage& image);

    Rgb radiance(const Vec3& direction) const;
    /// Density of sample(), per steradian.
    float pdf(const Vec3& direction) const;
    /// A unit direction: random[1] picks the row, [2] the column, [3] the place. black() must be false.
    Vec3 sample(const Draw& random) const;

    /// Mean over all directions, of the channels' mean: W / (m^2 sr).
    double mean_radiance() const { return mean_; }
    bool black() const { return !(mean_ > 0); }

  private:
    /// A place between four texel centres: the texels' columns and rows, and how far it lies from the first ones.
    struct Place {
        int x0, x1, y0, y1;
        int row;  ///< of patches
        float fx, fy;
        float sine;  ///< of the angle from the pole
    };

    Place place(const Vec3& direction) const;
    Rgb clean_texel(int x, int y) const;
    /// Luminance * sin(theta) at a texel's centre.
    float weight(int x, int y) const;
    float patch_height(int row) const { return row == 0 || row == height_ ? margin_ : 1.0f; }
    std::uint32_t column_begin(int row, int x) const;

    const TextureImage* image_;
    int width_, height_;
    float margin_;     ///< height of the image beyond the centres of its outer rows, in rows of texels
    float half_turn_;  ///< rows of texels from pole to pole
    float scale_;
    Vec3 x_axis_, y_axis_, z_axis_;
    double mean_ = 0;
    float inverse_peak_ = 0;              ///< keeps products of weights within float
    std::vector<float> sines_;            ///< per row of texels
    std::vector<std::uint32_t> rows_;     ///< begin of each row's share of 2^31, and their end
    std::vector<std::uint32_t> columns_;  ///< begin of each patch's share of 2^31 within its row
};

}  // namespace treefarm
