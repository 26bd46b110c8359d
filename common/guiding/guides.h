// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <tuple>
#include <utility>
#include <variant>

#include "common/guiding/grid/grid.h"
#include "common/guiding/qtable/qtable.h"
#include "common/guiding/sd_tree/sd_tree_guide.h"
#include "common/guiding/statistics/cell_accumulator.h"

namespace treefarm {

/// Requirements of a statistic: what a worker adds up from the records of a pass, in blocks of evidence. A log holds
/// the records of a work unit, of the guide's own type. Sums give the blocks names; their shape is a value.
template <class S>
concept Statistic = requires(S& statistic, typename S::Log& log, const typename S::Log& filled, Blocks blocks,
                             typename S::Sums sums, const typename S::Shape& shape) {
    log.begin(1u, 0u);
    /// Thread-safe.
    statistic.commit(filled);
    /// The sums, which start again from zero; cleared blocks may come back for reuse.
    { statistic.take() } -> std::same_as<typename S::Sums>;
    statistic.give_back(std::move(blocks));
    requires std::constructible_from<typename S::Sums, std::uint32_t, const typename S::Shape&>;
    requires std::constructible_from<typename S::Sums, std::uint32_t, const typename S::Shape&, Blocks>;
    { sums.take_blocks() } -> std::same_as<Blocks>;
    { S::Sums::caps_of(blocks) } -> std::same_as<UpdateCaps>;
};

/// Statistic of a guide: sums per cell, where it names none.
template <class G>
struct StatisticOfGuide {
    using type = CellAccumulator<typename G::Sampler>;
};
template <class G>
requires requires {
    typename G::Statistic;
}
struct StatisticOfGuide<G> {
    using type = typename G::Statistic;
};
template <class G>
using StatisticOf = typename StatisticOfGuide<G>::type;

/// Requirements of a guide (docs/use/write-a-guide.md). The model is a RegionModel with further plain values, fixed
/// during a pass. The sampler, flat and immutable, is built from a decoded model only, so that rounding for the wire
/// affects all processes equally; it has cells (cell_accumulator.h). The learner is the coordinator's memory of earlier
/// passes and archives itself for checkpoints: serialize().
template <class G>
concept Guide = std::derived_from<typename G::Model, RegionModel> &&
    std::derived_from<typename G::Sampler, RegionSampler> && Statistic<StatisticOf<G>> &&
    requires(const typename G::Model& model, typename G::Learner learner, const typename StatisticOf<G>::Sums& sums,
             RefineReport report) {
    /// Magic number: first four bytes of an encoded model.
    { G::kMagic } -> std::convertible_to<std::uint32_t>;
    /// Whether passes change the number of regions and cells.
    { G::kGrows } -> std::convertible_to<bool>;
    /// Number of kernels in worker/guides, and whether some of them are for plainly diffuse scenes only; otherwise the
    /// general ones are used there.
    { G::kKernels } -> std::convertible_to<int>;
    { G::kPlainKernels } -> std::convertible_to<bool>;
    { G::kCost } -> std::convertible_to<SamplerCost>;
    { G::first(Box3(), FirstModel()) } -> std::same_as<typename G::Model>;
    { G::encode(model) } -> std::same_as<Bytes>;
    /// Decodes a model. Checks all structural rules and throws FormatError.
    { G::decode(Bytes()) } -> std::same_as<typename G::Model>;
    { G::figures(model) } -> std::same_as<ModelFigures>;
    { learner.learn(model, sums, RefineSettings(), true, report) } -> std::same_as<typename G::Model>;
    { model == model } -> std::convertible_to<bool>;
    requires std::constructible_from<typename G::Sampler, const typename G::Model&>;
    requires std::constructible_from < StatisticOf<G>, std::uint32_t,
    const typename G::Sampler&, DirectionalFilter, bool > ;
} && requires(const typename G::Sampler& sampler) {
    /// A direction drawn in a region from three uniform numbers.
    { sampler.sample(0u, Draw()).pdf } -> std::convertible_to<float>;
    /// Density per steradian in a region of the direction with this code; and, for reports, its bytes.
    { sampler.pdf(0u, 0u) } -> std::same_as<float>;
    /// Mean radiance that a region has learned for the direction; negative if nothing was learned.
    { sampler.radiance(0u, 0u) } -> std::same_as<float>;
    { sampler.bytes() } -> std::same_as<std::size_t>;
};

/// List of guides, with a variant type for each of their parts.
template <Guide... G>
struct GuideList {
    static constexpr int kKernels = (... + G::kKernels);

    using Models = std::variant<typename G::Model...>;
    using Samplers = std::variant<typename G::Sampler...>;
    using Learners = std::variant<typename G::Learner...>;
    using Accumulators = std::variant<std::monostate, StatisticOf<G>...>;
    using Logs = std::tuple<typename StatisticOf<G>::Log...>;

    /// Calls visit.operator()<G>() for each guide until one call returns true. Returns whether one did.
    template <class Visit>
    static constexpr bool find(Visit visit) {
        return (... || visit.template operator()<G>());
    }
};

/// The guides of the program, in the order of GuideKind. The set is closed: the choice is made once per work unit.
enum class GuideKind : std::uint8_t { sd_tree, grid, qtable };
using Guides = GuideList<SdTreeGuide, GridGuide, QTableGuide>;

}  // namespace treefarm
