// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <utility>

#include "common/guiding/guides.h"
#include "common/guiding/regions/model_statistics.h"

namespace treefarm {

/// The guide that a model or a sampler belongs to.
template <class Part, class List>
struct GuideOfPart;
template <class Part, class First, class... Rest>
struct GuideOfPart<Part, GuideList<First, Rest...>> {
    static constexpr bool kIsFirst =
        std::is_same_v<Part, typename First::Model> || std::is_same_v<Part, typename First::Sampler>;
    using type =
        typename std::conditional_t<kIsFirst, std::type_identity<First>, GuideOfPart<Part, GuideList<Rest...>>>::type;
};
template <class Part>
using GuideOf = typename GuideOfPart<std::remove_cvref_t<Part>, Guides>::type;

/// Calls visit.operator()<G>() for the guide of a kind; RunError if there is none.
template <class Visit>
void with_guide(GuideKind kind, Visit visit) {
    int index = 0;
    const bool found = Guides::find([&]<class G>() {
        if (index++ != static_cast<int>(kind)) return false;
        visit.template operator()<G>();
        return true;
    });
    if (!found) throw RunError("the program has no such guide");
}

/// A model of any guide, for all that need not know which.
class AnyModel {
  public:
    AnyModel() = default;
    template <class M>
    requires std::derived_from<std::remove_cvref_t<M>, RegionModel>
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): no model is an AnyModel
    AnyModel(M&& model) : model_(std::forward<M>(model)) {}

    static AnyModel first(GuideKind kind, const Box3& bounds, const FirstModel& settings);
    /// By the guide whose magic the bytes begin with; FormatError if there is none, or they are not a model of it.
    static AnyModel decode(std::span<const std::uint8_t> bytes);
    Bytes encode() const;

    GuideKind kind() const { return static_cast<GuideKind>(model_.index()); }
    const RegionModel& regions() const;
    bool trained() const { return regions().trained; }
    void set_pass(std::uint32_t pass);
    /// Lets next event learn how to choose emitters, from a choice by power on where it has not, or forgets that.
    void set_learns_lights(bool learns);
    /// Lets next event be decided by region, from always on where it was not, or forgets that.
    void set_decides_next_event(bool decides);
    void set_image(ImageFacts image);
    ModelFigures figures() const;
    /// About the bytes of the form that workers sample from.
    SamplerCost cost() const;
    bool grows() const;

    /// Shape of the sums of a pass over the model; `with_mixture`: it learns mixtures.
    SumsShape sums_shape(bool with_mixture) const;

    // What inspection shows: of a guide's own where it has such functions, else of its size and its sampler.

    /// Figures of the model; `encoded_bytes` as it is sent and stored.
    TreeStatistics statistics(std::uint64_t encoded_bytes) const;
    /// Cells that each region answers for.
    std::vector<double> cells_by_region() const;
    /// A distribution over directions averaged over the squares of a grid of 2^bits by 2^bits on the direction square
    /// (direction_map.h), in row order from v = 0: per steradian, so that the mean is 1 / (4 pi).
    std::vector<float> density_map(std::uint32_t distribution, int bits) const;

    /// The model, if it is one of this kind.
    template <class M>
    const M* get_if() const {
        return std::get_if<M>(&model_);
    }
    /// Calls visit.operator()<G>(model) for the model's guide.
    template <class Visit>
    decltype(auto) visit(Visit visit) const {
        return std::visit([&]<class M>(const M& model) { return visit.template operator()<GuideOf<M>>(model); },
                          model_);
    }
    bool operator==(const AnyModel&) const = default;

  private:
    Guides::Models model_;
};

/// A sampler of any guide. Immutable; one per process, shared by its threads.
class AnySampler {
  public:
    explicit AnySampler(const AnyModel& model);
    template <class S>
    requires std::derived_from<std::remove_cvref_t<S>, RegionSampler>
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): no sampler is an AnySampler
    AnySampler(S&& sampler) : sampler_(std::forward<S>(sampler)) {}

    GuideKind kind() const { return static_cast<GuideKind>(sampler_.index()); }
    const RegionSampler& regions() const {
        return std::visit([](const RegionSampler& regions) -> const RegionSampler& { return regions; }, sampler_);
    }
    /// The sampler, which is one of this type.
    template <class S>
    const S& get() const {
        if constexpr (std::is_same_v<S, RegionSampler>)
            return regions();
        else
            return std::get<S>(sampler_);
    }
    /// Calls visit.operator()<G>(sampler) for the sampler's guide.
    template <class Visit>
    decltype(auto) visit(Visit visit) const {
        return std::visit([&]<class S>(const S& sampler) { return visit.template operator()<GuideOf<S>>(sampler); },
                          sampler_);
    }

  private:
    Guides::Samplers sampler_;
};

/// What adds the records of finished work by the cells of any guide (CellAccumulator).
class AnyAccumulator {
  public:
    AnyAccumulator(std::uint32_t pass, const AnySampler& guide, DirectionalFilter filter, bool with_mixture);

    void commit(std::span<const Record> records, std::span<const std::uint32_t> counts, const UpdateCaps& caps,
                std::span<const NextEventSums> next_event = {});
    CellSums take();
    void give_back(CellSums cleared);

  private:
    Guides::Accumulators accumulator_;
};

/// The coordinator's memory of what any guide has learned: the way from what a pass recorded to the model that guides
/// the next one. Pure but for that memory.
class AnyLearner {
  public:
    /// `learn_mixture`: the pass recorded histograms.
    AnyModel learn(const AnyModel& model, const CellSums& sums, const RefineSettings& settings, bool learn_mixture,
                   RefineReport& report);

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        auto kind = static_cast<std::uint8_t>(learner_.index());
        archive(kind);
        if (kind != learner_.index()) forget(kind);
        std::visit([&](auto& learner) { archive(learner); }, learner_);
    }

  private:
    /// Begins anew as the learner of a guide; FormatError if there is no such guide.
    void forget(std::uint8_t kind);

    Guides::Learners learner_;
};

}  // namespace treefarm
