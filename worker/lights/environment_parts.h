// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace treefarm {

/// A rectangle of an environment map's texels, one part of its image. It was cut off from part `cut_from`: the texels
/// from `cut_at` on. Part 0 is the remainder of the whole.
struct EnvironmentPart {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< texels [x0, x1) x [y0, y1)
    int cut_from = -1;
    bool cut_rows = false;  ///< the cut is between rows, not columns
    int cut_at = 0;

    bool holds(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

/// Which of `count` parts holds a texel; `part(i)` is the i-th.
template <class Part>
int part_of(int x, int y, int count, Part part) {
    int found = 0;
    // A part that is cut loses its upper side to the new part.
    for (int i = 1; i < count; ++i) {
        const EnvironmentPart& cut = part(i);
        if (cut.cut_from == found && (cut.cut_rows ? y : x) >= cut.cut_at) found = i;
    }
    return found;
}

/// Partition of an environment map into parts that next event can learn to choose among. The cost of a part is its
/// power times its solid angle; each cut is the one that lowers the sum most (after the surface area heuristic). A
/// small and powerful sun is therefore cut out first; an even sky is halved.
class EnvironmentGrid {
  public:
    EnvironmentGrid(int width, int height);

    /// Adds a texel: its sampling weight and its solid angle, both in any unit.
    void add(int x, int y, double weight, double solid_angle);

    std::vector<EnvironmentPart> parts(int most) const;

  private:
    /// Largest number of blocks of texels, so that large images cost no more.
    static constexpr int kMostColumns = 512, kMostRows = 256;

    struct Sums {
        double weight = 0, solid_angle = 0;
        double cost() const { return weight * solid_angle; }
    };
    struct Cut {
        double gain = 0;
        bool rows = false;
        int at = 0;
    };
    Cut best_cut(const EnvironmentPart& blocks) const;

    int width_, height_, columns_, rows_;
    std::vector<Sums> blocks_;
};

}  // namespace treefarm
