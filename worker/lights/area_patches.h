// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "common/math/vec.h"
#include "worker/lights/discrete_table.h"

namespace treefarm {

/// Patches of an emitting mesh, which next event chooses individually: near parts of a large mesh contribute more than
/// far ones. Within a patch triangles are chosen by area.
class AreaPatches {
  public:
    /// At most so many, whatever the areas are.
    static constexpr std::size_t kMostPatches = 256;
    /// Patches are not cut further that have so few triangles, or at most this share of the mesh's area.
    static constexpr std::size_t kFewTriangles = 16;
    static constexpr double kSmallShare = 1.0 / 64;

    AreaPatches() = default;  ///< uncut
    /// `center`: centre of each triangle that has an area. A mesh with few triangles stays uncut.
    AreaPatches(std::span<const double> areas, const std::function<Vec3(std::uint32_t)>& center);

    /// Number of patches; 0: uncut.
    std::uint32_t count() const { return static_cast<std::uint32_t>(tables_.size()); }
    /// Triangles of a patch, in the order of its table.
    std::span<const std::uint32_t> triangles(std::uint32_t patch) const {
        return std::span(triangles_).subspan(begin_[patch], begin_[patch + 1] - begin_[patch]);
    }
    /// Fraction of the area in a patch.
    double share(std::uint32_t patch) const { return share_[patch]; }
    /// Patch of a triangle that has an area.
    std::uint32_t patch_of(std::uint32_t triangle) const { return patch_of_[triangle]; }
    /// Triangle of a patch, chosen by 32 random bits.
    std::uint32_t pick(std::uint32_t patch, std::uint32_t bits) const {
        return triangles_[begin_[patch] + tables_[patch].pick(bits)];
    }
    /// Density per area of the points of each triangle within its patch.
    const std::vector<float>& density() const { return density_; }

  private:
    std::vector<std::uint32_t> triangles_;  ///< sorted by patch
    std::vector<std::uint32_t> begin_;      ///< of each patch, and one past the last
    std::vector<DiscreteTable> tables_;     ///< of each patch
    std::vector<double> share_;
    std::vector<float> density_;
    std::vector<std::uint16_t> patch_of_;
};

}  // namespace treefarm
