#include "common/guiding/refine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace treefarm {
namespace {

__extension__ using Wide = unsigned __int128;

/// Beyond this many cells a region no longer splits, so that indices stay below 2^32.
constexpr std::uint64_t kMaxCells = std::uint64_t{1} << 31;

/// The directional quadtree of one region on its refined topology, cells in Z-order.
struct Directions {
    std::vector<std::uint8_t> depth;
    std::vector<std::uint32_t> mass;
};

/// Energy of a cell: `sum` quartered `quarters` times.
struct Energy {
    std::uint64_t sum = 0;
    int quarters = 0;
};

class DirectionRefiner {
  public:
    DirectionRefiner(std::span<const std::uint8_t> depth, std::span<const std::uint64_t> sum, std::uint32_t divisor,
                     RefineReport& report)
        : depth_(depth), sum_(sum), divisor_(divisor), report_(report) {
        for (const std::uint64_t s : sum)
            total_ += s;
    }

    Directions run() {
        visit(0, 0, depth_.size());
        assign_masses();
        return std::move(result_);
    }

  private:
    /// "More than 1/divisor of the energy"; an empty region splits as if energy were spread evenly.
    bool splits(int depth, const Wide& sum, int quarters) const {
        if (depth == 0) return true;
        if (total_ == 0) return (Wide{1} << (2 * depth)) < divisor_;
        return divisor_ * sum > (total_ << (2 * quarters));
    }

    bool may_split(int depth, const Wide& sum, int quarters) {
        if (!splits(depth, sum, quarters)) return false;
        if (depth < kMaxDirectionDepth) return true;
        ++report_.directional_depth_capped;
        return false;
    }

    /// The node of this depth that holds the old cells [begin, end).
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

    /// (Part of) one old cell.
    void visit_cell(int depth, Energy energy) {
        if (!may_split(depth, energy.sum, energy.quarters)) return emit(depth, energy);
        for (int child = 0; child < 4; ++child)
            visit_cell(depth + 1, {energy.sum, energy.quarters + 1});
    }

    void emit(int depth, Energy energy) {
        result_.depth.push_back(static_cast<std::uint8_t>(depth));
        energies_.push_back(energy);
        report_.directional_depth = std::max(report_.directional_depth, depth);
    }

    /// Probabilities as integers that sum to 2^kMassBits exactly: sampling and density use the same table. A cell with
    /// energy keeps at least one unit; what rounding leaves goes to the largest cell.
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
    RefineReport& report_;
    Wide total_ = 0;
    std::vector<Energy> energies_;
    Directions result_;
};

std::uint64_t integer_root(Wide value) {
    Wide root = static_cast<Wide>(std::sqrt(static_cast<double>(value)));  // right to 53 bits; made exact below
    while (root * root > value)
        --root;
    while ((root + 1) * (root + 1) <= value)
        ++root;
    return static_cast<std::uint64_t>(root);
}

/// Turns a cell's second moment, an integral over the cell, into what it is to be sampled in proportion to: the
/// variance of an estimate is least where probability follows sqrt(moment * area).
std::uint64_t deviation(std::uint64_t moment, std::uint8_t depth) {
    return integer_root(Wide{moment} << (2 * (kMaxDirectionDepth - depth)));
}

class TreeRefiner {
  public:
    TreeRefiner(const SdTree& tree, const TreeSums& sums, const RefineSettings& settings, RefineReport& report)
        : old_(tree), sums_(sums), settings_(settings), report_(report) {}

    SdTree run() {
        result_.pass = old_.pass + 1;
        result_.trained = true;
        result_.origin = old_.origin;
        result_.extent = old_.extent;
        result_.cell_begin.push_back(0);
        copy(0, 0);
        report_.mean_cells = static_cast<double>(result_.cell_count()) / result_.region_count();
        return std::move(result_);
    }

  private:
    std::uint32_t copy(std::uint32_t old_node, int depth) {
        const SdTree::Node& node = old_.nodes[old_node];
        if (node.is_leaf()) {
            old_region_ = node.child[1];
            leaf_depth_ = depth;
            return split(refine_region(old_region_), depth);
        }
        const auto index = add_node();
        const std::uint32_t low = copy(node.child[0], depth + 1);
        const std::uint32_t high = copy(node.child[1], depth + 1);
        result_.nodes[index] = {{low, high}};
        return index;
    }

    struct Region {
        Directions directions;
        std::int16_t quantum_exponent;
        double weight;  ///< records, weighted; halves with each split
    };

    Region refine_region(std::uint32_t r) {
        const std::uint32_t begin = old_.cell_begin[r], count = old_.cell_begin[r + 1] - begin;
        std::span<const std::uint64_t> energies(&sums_.cells()[begin], count);
        Wide total = 0;
        for (const std::uint64_t sum : energies)
            total += sum;
        if (settings_.target == GuidingTarget::variance) {
            deviations_.resize(count);
            for (std::uint32_t c = 0; c < count; ++c)
                deviations_[c] = deviation(energies[c], old_.cell_depth[begin + c]);
            energies = deviations_;
        }
        DirectionRefiner refiner({&old_.cell_depth[begin], count}, energies, settings_.directional_divisor, report_);
        Region region{refiner.run(), old_.quantum_exponent[r],
                      static_cast<double>(sums_.counts()[r]) * settings_.record_weight};
        if (total > 0 && sums_.counts()[r] > 0) {
            const double mean_quanta = static_cast<double>(total) / static_cast<double>(sums_.counts()[r]);
            const double mean_record = std::ldexp(mean_quanta, old_.quantum_exponent[r]);
            constexpr double kMost = std::numeric_limits<float>::max();
            region.quantum_exponent = quantum_exponent_for(static_cast<float>(std::min(mean_record, kMost)));
        }
        return region;
    }

    std::uint32_t split(const Region& region, int depth) { return split(region, region.weight, depth); }

    std::uint32_t split(const Region& region, double weight, int depth) {
        const auto index = add_node();
        if (weight > settings_.spatial_threshold) {
            const bool room = result_.cell_depth.size() + region.directions.depth.size() < kMaxCells;
            if (depth < kMaxSpatialDepth && room) {
                const std::uint32_t low = split(region, weight / 2, depth + 1);
                const std::uint32_t high = split(region, weight / 2, depth + 1);
                result_.nodes[index] = {{low, high}};
                return index;
            }
            ++(room ? report_.spatial_depth_capped : report_.memory_capped);
        }
        report_.spatial_depth = std::max(report_.spatial_depth, depth);
        result_.nodes[index] = {{0, result_.region_count()}};
        const Directions& d = region.directions;
        result_.cell_depth.insert(result_.cell_depth.end(), d.depth.begin(), d.depth.end());
        result_.cell_mass.insert(result_.cell_mass.end(), d.mass.begin(), d.mass.end());
        result_.cell_begin.push_back(result_.cell_count());
        result_.quantum_exponent.push_back(region.quantum_exponent);
        result_.bsdf_fraction.push_back(old_.bsdf_fraction[old_region_]);
        report_.origins.push_back({old_region_, depth - leaf_depth_});
        return index;
    }

    std::uint32_t add_node() {
        result_.nodes.emplace_back();
        return static_cast<std::uint32_t>(result_.nodes.size() - 1);
    }

    const SdTree& old_;
    const TreeSums& sums_;
    const RefineSettings& settings_;
    RefineReport& report_;
    SdTree result_;
    std::uint32_t old_region_ = 0;  ///< that is being refined
    int leaf_depth_ = 0;            ///< its depth
    std::vector<std::uint64_t> deviations_;
};

}  // namespace

SdTree refine(const SdTree& tree, const TreeSums& sums, const RefineSettings& settings, RefineReport& report) {
    if (sums.cells().size() != tree.cell_count() || sums.counts().size() != tree.region_count())
        throw RunError("the sums to refine by belong to another tree");
    report = {};
    return TreeRefiner(tree, sums, settings, report).run();
}

}  // namespace treefarm
