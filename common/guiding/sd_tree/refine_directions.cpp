// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree/refine_directions.h"

#include <algorithm>
#include <cmath>

#include "common/guiding/sd_tree/sd_tree.h"

namespace treefarm {
namespace {

__extension__ using Wide = unsigned __int128;

/// Energy of a cell: `sum` divided by 4^`quarters`.
struct Energy {
    std::uint64_t sum = 0;
    int quarters = 0;
};

class DirectionRefiner {
  public:
    DirectionRefiner(std::span<const std::uint8_t> depth, std::span<const std::uint64_t> sum, std::uint32_t divisor)
        : depth_(depth), sum_(sum), divisor_(divisor) {
        for (const std::uint64_t s : sum)
            total_ += s;
    }

    RefinedDirections run() {
        visit(0, 0, depth_.size());
        assign_masses();
        return std::move(result_);
    }

  private:
    /// Whether the energy is more than 1/divisor of the total; without any energy, cells split as if it were spread
    /// evenly.
    bool splits(int depth, const Wide& sum, int quarters) const {
        if (depth == 0) return true;
        if (total_ == 0) return (Wide{1} << (2 * depth)) < divisor_;
        return divisor_ * sum > (total_ << (2 * quarters));
    }

    bool may_split(int depth, const Wide& sum, int quarters) {
        if (!splits(depth, sum, quarters)) return false;
        if (depth < kMaxDirectionDepth) return true;
        ++result_.depth_capped;
        return false;
    }

    /// Visits the node of this depth that covers the old cells [begin, end).
    void visit(int depth, std::size_t begin, std::size_t end) {
        if (end - begin == 1) return visit_cell(depth, {sum_[begin], 0});
        Wide sum = 0;
        for (std::size_t i = begin; i < end; ++i)
            sum += sum_[i];
        if (!may_split(depth, sum, 0)) return emit(depth, {static_cast<std::uint64_t>(sum), 0});
        std::size_t at = begin;
        for (int child = 0; child < 4; ++child) {
            const std::uint64_t size = std::uint64_t{1} << (2 * (kMaxDirectionDepth - depth - 1));
            const std::size_t first = at;
            for (std::uint64_t filled = 0; filled < size; ++at)
                filled += std::uint64_t{1} << (2 * (kMaxDirectionDepth - depth_[at]));
            visit(depth + 1, first, at);
        }
    }

    /// Visits an old cell, or a part of one.
    void visit_cell(int depth, Energy energy) {
        if (!may_split(depth, energy.sum, energy.quarters)) return emit(depth, energy);
        for (int child = 0; child < 4; ++child)
            visit_cell(depth + 1, {energy.sum, energy.quarters + 1});
    }

    void emit(int depth, Energy energy) {
        result_.depth.push_back(static_cast<std::uint8_t>(depth));
        energies_.push_back(energy);
        result_.max_depth = std::max(result_.max_depth, depth);
    }

    /// Sets the probabilities, as integers that sum to 2^kMassBits exactly, so that sampling and density use one table.
    /// A cell with energy keeps at least one unit; the rounding error goes to the largest cell.
    void assign_masses() {
        constexpr std::int64_t kWhole = std::int64_t{1} << kMassBits;
        std::int64_t left = kWhole;
        std::size_t largest = 0;
        for (std::size_t i = 0; i < energies_.size(); ++i) {
            std::int64_t mass = kWhole >> (2 * result_.depth[i]);
            if (total_ > 0) {
                const auto& [sum, quarters] = energies_[i];
                const Wide scaled = (Wide{sum} << kMassBits) / total_;
                mass = sum == 0 ? 0 : std::max<std::int64_t>(1, static_cast<std::int64_t>(scaled >> (2 * quarters)));
            }
            result_.mass.push_back(static_cast<std::uint32_t>(mass));
            left -= mass;
            if (mass > result_.mass[largest]) largest = i;
        }
        result_.mass[largest] = static_cast<std::uint32_t>(result_.mass[largest] + left);
    }

    std::span<const std::uint8_t> depth_;
    std::span<const std::uint64_t> sum_;
    std::uint32_t divisor_;
    Wide total_ = 0;
    std::vector<Energy> energies_;
    RefinedDirections result_;
};

std::uint64_t integer_root(Wide value) {
    Wide root = static_cast<Wide>(std::sqrt(static_cast<double>(value)));  // right to 53 bits; made exact below
    while (root * root > value)
        --root;
    while ((root + 1) * (root + 1) <= value)
        ++root;
    return static_cast<std::uint64_t>(root);
}

}  // namespace

RefinedDirections refine_directions(std::span<const std::uint8_t> depth, std::span<const std::uint64_t> sum,
                                    std::uint32_t divisor) {
    return DirectionRefiner(depth, sum, divisor).run();
}

std::uint64_t deviation(std::uint64_t moment, std::uint8_t depth) {
    return integer_root(Wide{moment} << (2 * (kMaxDirectionDepth - depth)));
}

}  // namespace treefarm
