#pragma once

#include <cstdint>
#include <vector>

#include "common/base/random.h"
#include "common/scene/emitter.h"
#include "worker/textures/texture_set.h"

namespace treefarm {

/// A distant sphere of radiance from an image, and how to sample it.
///
/// Radiance is interpolated between texel centres; u repeats, v ends at the poles. A direction is drawn by picking a
/// texel in proportion to luminance * sin(theta) and moving from its centre by a tent of one texel to each side (by its
/// mirror image beyond a pole). So the density over (u, v) interpolates the texels' probabilities just as radiance is
/// interpolated: it is continuous, follows the radiance within texels, and vanishes only where the radiance does. It is
/// read from the very table that texels are picked from.
///
/// Tables are searched from guide entries, so that a column costs one line of cache however long the row is. Memory:
/// 4.25 bytes for each texel besides the image itself, 0.6 MB for 512 x 256, 143 MB for 8192 x 4096.
class EnvironmentMap {
  public:
    /// Texels that are negative or not finite count as black. `image` must outlive it; `emitter.scale` is at least 0.
    EnvironmentMap(const EnvironmentEmitter& emitter, const TextureImage& image);

    struct Sample {
        Vec3 direction;  ///< unit
        float pdf;       ///< per steradian
    };

    Rgb radiance(const Vec3& direction) const;
    /// Density of sample(), per steradian.
    float pdf(const Vec3& direction) const;
    /// random[1] picks the row, [2] the column, [3] the place. black() must be false.
    Sample sample(const Draw& random) const;

    /// Mean over all directions, of the channels' mean: W / (m^2 sr).
    double mean_radiance() const { return mean_; }
    bool black() const { return !(mean_ > 0); }

  private:
    /// A place between four texel centres: the texels' columns and rows, and how far it lies from the first ones.
    struct Place {
        int x0, x1, y0, y1;
        float fx, fy;
    };

    /// In texels from the centre of the first one; u at most one and a half outside [0, width).
    Place place(float u, float v) const;
    /// The same of a direction; `sine` becomes that of its angle from the pole.
    Place place(const Vec3& direction, float& sine) const;
    float pdf(const Place& place, float sine) const;
    Rgb clean_texel(int x, int y) const;
    bool on_pole(int y) const { return margin_ == 0.0f && (y == 0 || y == height_ - 1); }
    /// A row's probability, and a texel's within its row, of 2^31. A tent about a pole is folded in two.
    float row_density(int y) const;
    float column_share(int x, int y) const;
    int pick_column(int y, std::uint32_t bits) const;

    const TextureImage* image_;
    int width_, height_;
    float margin_;     ///< height of the image beyond the centres of its outer rows, in rows of texels
    float half_turn_;  ///< rows of texels from pole to pole
    float scale_;
    Vec3 x_axis_, y_axis_, z_axis_;
    bool clean_ = false;  ///< no texel is negative, infinite or not a number
    double mean_ = 0;
    float density_scale_;                 ///< from a texel's probability, of 2^62, to a density times sin(theta)
    std::vector<std::uint32_t> rows_;     ///< begin of each row's share of 2^31, and their end
    std::vector<std::uint32_t> columns_;  ///< per row: begin of each texel's share of 2^31 within it, and their end
    int guide_bits_;                      ///< a row has 2^guide_bits_ guide entries, and one more
    std::vector<std::uint32_t> guide_;    ///< entry k of a row: the column that owns k 2^-guide_bits_
};

}  // namespace treefarm
