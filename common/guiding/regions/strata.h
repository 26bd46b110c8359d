// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/base/random.h"
#include "common/guiding/regions/first_model.h"
#include "common/guiding/regions/refinement.h"
#include "common/guiding/regions/region_sampler.h"

namespace treefarm {

/// Common part of guides with fixed regions and cells. The regions are an even grid of the cube; the cells of each are
/// 8 by 8 strata of the direction square (direction_map.h), in Z-order and of equal solid angle.
inline constexpr int kStrataDepth = 3;
inline constexpr std::uint32_t kStrata = 1u << (2 * kStrataDepth);

/// Sets the common part of a model before any pass: 2^grid_halvings regions. Returns their number.
std::uint32_t begin_even_regions(RegionModel& model, const Box3& bounds, const FirstModel& settings);
/// Advances the common part by one pass, as far as it does not depend on records, and fills the report.
void advance_even_regions(RegionModel& model, RefineReport& report);
/// Reads the common part, with one exponent per region. Returns the number of regions. Throws FormatError.
std::uint32_t read_even_regions(ByteReader& in, RegionModel& model);
ModelFigures even_figures(const RegionModel& model);

/// Probabilities of a region's strata, times 2^kMassBits, their sum: proportional to `weight`, whose sum is above 0,
/// plus a total of `even_part` shared equally.
void set_strata(std::span<const double> weight, double even_part, std::uint32_t* mass);

/// Regions and their strata in the form that workers sample from.
class StrataSampler : public RegionSampler {
  public:
    /// `mass`: probabilities of kStrata strata for each region, with sum 2^kMassBits.
    StrataSampler(const RegionModel& model, std::vector<std::uint32_t> mass)
        : RegionSampler(model), mass_(std::move(mass)) {}

    /// A sampled point of the direction square, with the density of the stratum that it was drawn from.
    struct SquareSample {
        Vec2 at;
        std::uint32_t code;  ///< its Z-order code, inside the sampled stratum
        float pdf;           ///< per steradian of the direction
    };
    /// A sampled direction.
    struct Sample {
        Vec3 direction;      ///< unit length
        std::uint32_t code;  ///< its Z-order code, inside the sampled stratum
        float pdf;           ///< per steradian
    };
    Sample sample(std::uint32_t region, const Draw& random) const;
    /// Draws a point; `pick`, `u0` and `u1` are uniform 32-bit numbers.
    SquareSample sample_square(std::uint32_t region, std::uint32_t pick, std::uint32_t u0, std::uint32_t u1) const;
    float pdf(std::uint32_t region, std::uint32_t code) const;

    // Cells of records, for CellAccumulator.
    std::uint32_t cell_count() const { return static_cast<std::uint32_t>(mass_.size()); }
    static std::uint32_t cell(std::uint32_t region, std::uint32_t code);
    static std::uint32_t cell_side(std::uint32_t region = 0, std::uint32_t code = 0);
    void prefetch_pdf(std::uint32_t, std::uint32_t) const {}
    void prefetch_pdf_cell(std::uint32_t, std::uint32_t) const {}

    std::size_t bytes() const { return region_bytes() + mass_.size() * sizeof(mass_[0]); }

  private:
    std::vector<std::uint32_t> mass_;
};

}  // namespace treefarm
