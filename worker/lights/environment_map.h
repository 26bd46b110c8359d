// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/base/random.h"
#include "common/scene/model/emitter.h"
#include "worker/lights/environment_batch.h"
#include "worker/lights/environment_parts.h"
#include "worker/lights/light_bounds.h"
#include "worker/textures/texture_set.h"

namespace treefarm {

/// Environment map: a distant sphere of radiance from an image, and its sampling.
///
/// Radiance is interpolated between texel centres; u repeats, v ends at the poles. A direction is drawn by picking a
/// texel in proportion to luminance * sin(theta) and offsetting its centre by a tent of one texel to each side
/// (mirrored beyond a pole). The density over (u, v) thus interpolates the texels' probabilities just as radiance is
/// interpolated: it is continuous, follows the radiance within texels, and is 0 only where the radiance is. It is read
/// from the same table that texels are picked from.
///
/// The image is cut into a few rectangles ("parts") of little power, little size or both, so that next event can learn
/// which of them are visible from a point: a sun is a part of its own.
///
/// Tables are searched from look-up entries, so that a column costs one cache line whatever the row's length. Memory: 6
/// bytes per texel besides the image itself, 0.8 MB for 512 x 256, 201 MB for 8192 x 4096.
class EnvironmentMap {
  public:
    /// Texels that are negative or not finite count as black. `image` must outlive the map; `emitter.scale` is at least
    /// 0.
    EnvironmentMap(const EnvironmentEmitter& emitter, const TextureImage& image);

    using Footprint = TexelFootprint;
    using Sample = EnvironmentSample;

    static constexpr int kMostParts = 8;
    /// Probability of each part.
    using PartChoice = std::array<float, kMostParts>;

    int part_count() const { return static_cast<int>(parts_.size()); }
    /// Fraction of the image's power in a part.
    double part_weight(int part) const { return parts_[static_cast<std::size_t>(part)].weight; }

    Rgb radiance(const Vec3& direction) const;
    Rgb radiance(const Footprint& footprint) const;
    /// Prefetches the data of radiance() and pdf() for a footprint.
    void prefetch(const Footprint& footprint) const;
    /// Density of sample(), per steradian, with the parts' probabilities `choice`.
    float pdf(const Vec3& direction, const PartChoice& choice) const;
    float pdf(const Sample& sample, const PartChoice& choice) const {
        return pdf(sample.footprint, sample.sine, choice);
    }
    /// Sample of a chosen part, which must have weight: random[1] picks the row, [2] the column, [3] the point.
    Sample sample(int part, const Draw& random) const;
    /// Sample of a given direction, as if it had been drawn.
    Sample towards(const Vec3& direction) const {
        float sine;
        const Footprint found = footprint(direction, sine);
        return {direction, found, sine};
    }
    /// Calls f(part) for each part that affects the density at a footprint; a part may come twice.
    template <class F>
    void for_each_part(const Footprint& p, F&& f) const {
        const int first = part_of(p.x0, p.y0);
        f(first);
        if (parts_[static_cast<std::size_t>(first)].texels.holds(p.x1, p.y1)) return;
        f(part_of(p.x1, p.y0));
        f(part_of(p.x0, p.y1));
        f(part_of(p.x1, p.y1));
    }
    /// Draws all samples of a batch.
    void sample(EnvironmentBatch& batch) const;

    /// Mean over all directions of the channels' mean: W / (m^2 sr).
    double mean_radiance() const { return mean_; }
    /// Mean luminance over all directions.
    double mean_luminance() const { return mean_luminance_; }
    /// Cone that contains all directions of a part.
    DirectionCone part_cone(int part) const;
    bool black() const { return !(mean_ > 0); }

  private:
    /// A rectangle of texels with its rows' probabilities.
    struct Part {
        /// Begin and end of the part's columns within the row's 2^31, and the row's probability over that width.
        struct Row {
            std::uint32_t begin, end;
            float density;
        };
        EnvironmentPart texels;
        double weight;                          ///< fraction of the image's power
        std::vector<std::uint32_t> row_begin;   ///< begin of each row's interval in [0, 2^31], and the end
        std::vector<std::uint32_t> row_lookup;  ///< entry k: the row whose interval contains k 2^-kRowLookupBits
        std::vector<Row> rows;
    };
    static constexpr int kRowLookupBits = 8;

    /// Texels about a direction, and their weights; `sine` is set to that of its angle from the pole.
    Footprint footprint(const Vec3& direction, float& sine) const;
    float pdf(const Footprint& footprint, float sine, const PartChoice& choice) const;
    Rgb clean_texel(int x, int y) const;
    bool on_pole(int y) const { return frame_.margin == 0.0f && (y == 0 || y == frame_.height - 1); }
    void add_part(const EnvironmentPart& part, double whole, const std::vector<double>& row_weights);
    int part_of(int x, int y) const;
    /// Probability of a texel within its part. A tent across a pole is folded.
    float density(int part, int x, int y) const;
    const std::uint32_t* columns(int y) const {
        return &columns_[static_cast<std::size_t>(y) * (static_cast<std::size_t>(frame_.width) + 1)];
    }
    std::uint32_t column_begin(int x, int y) const { return columns(y)[x]; }
    const std::uint32_t* lookup(int y, std::uint32_t bits) const;
    int pick_row(const Part& part, std::uint32_t bits) const;
    /// Maps bits to the interval of the part's columns in a row.
    std::uint32_t bits_in_part(const Part& part, int y, std::uint32_t bits) const;

    const TextureImage* image_;
    /// Mapping between image and directions.
    struct Frame {
        int width, height;
        float margin;     ///< height of the image beyond the centres of its outer rows, in rows of texels
        float half_turn;  ///< rows of texels from pole to pole
        Vec3 x_axis, y_axis, z_axis;

        /// Footprint at (u, v) in texels from the first centre; u at most one and a half outside [0, width).
        Footprint footprint(float u, float v) const;
        /// Unit direction of a column, and of a row given by its distance from the pole in rows of texels.
        Vec3 direction(float u, float from_pole) const;
        /// Sample of a texel, with the offset by the bits of its tents.
        Sample locate(int x, int y, std::uint32_t tent_bits) const;
    };
    Frame frame_;
    float scale_;
    bool clean_ = false;  ///< no texel is negative, infinite or NaN
    double mean_ = 0, mean_luminance_ = 0;
    std::vector<Part> parts_;
    float density_scale_;                 ///< factor from a texel's probability to density times sin(theta)
    std::vector<std::uint32_t> columns_;  ///< per row: begin of each texel's interval in [0, 2^31], and the end
    int lookup_bits_;                     ///< a row has 2^lookup_bits_ look-up entries, and one more
    std::vector<std::uint32_t> lookup_;   ///< entry k of a row: the column whose interval contains k 2^-lookup_bits_
};

}  // namespace treefarm
