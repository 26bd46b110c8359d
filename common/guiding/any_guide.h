// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <utility>

#include "common/guiding/guides.h"
#include "common/guiding/regions/model_statistics.h"

namespace treefarm {

/// Maps a model or sampler type to its guide.
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

/// Kind of a guide.
template <class G>
constexpr GuideKind kind_of() {
    int index = -1;
    const bool found = Guides::find([&]<class Other>() {
        ++index;
        return std::is_same_v<G, Other>;
    });
    if (!found) throw RunError("the program has no such guide");
    return static_cast<GuideKind>(index);
}

/// Calls visit.operator()<G>() for the guide of this kind. Throws RunError if there is none.
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

/// A model of any guide, for code that does not depend on which.
class AnyModel {
  public:
    AnyModel() = default;
    template <class M>
    requires std::derived_from<std::remove_cvref_t<M>, RegionModel>  // so never an AnyModel: NOLINTNEXTLINE
    AnyModel(M&& model) : model_(std::forward<M>(model)) {}

    static AnyModel first(GuideKind kind, const Box3& bounds, const FirstModel& settings);
    /// Decodes a model of the guide whose magic number the bytes begin with. Throws FormatError for unknown guides and
    /// malformed bytes.
    static AnyModel decode(std::span<const std::uint8_t> bytes);
    Bytes encode() const;

    GuideKind kind() const { return static_cast<GuideKind>(model_.index()); }
    const RegionModel& regions() const;
    bool trained() const { return regions().trained; }
    void set_pass(std::uint32_t pass);
    /// Switches learning of emitter choice in next event on, starting with choice by power where nothing is learned, or
    /// off, which forgets what was learned.
    void set_learns_lights(bool learns);
    /// Switches decisions on next event per region on, starting with one sample per vertex, or off, which forgets them.
    void set_decides_next_event(bool decides);
    void set_image(ImageFacts image);
    ModelFigures figures() const;
    /// Approximate bytes of the form that workers sample from.
    SamplerCost cost() const;
    bool grows() const;

    /// Empty blocks of what the pass with this number over the model records. `with_mixture`: also for learning
    /// mixtures.
    Blocks blocks(std::uint32_t pass, bool with_mixture) const;
    /// Limits that were reached, of blocks of a pass over the model.
    UpdateCaps caps(const Blocks& blocks) const;

    // For inspection: functions of the guide where it has them, otherwise derived from its size and its sampler.

    /// Statistics of the model. `encoded_bytes`: its size as sent and stored.
    TreeStatistics statistics(std::uint64_t encoded_bytes) const;
    /// Number of cells per region.
    std::vector<double> cells_by_region() const;
    /// Mean density of a distribution over directions, per square of a grid of 2^bits by 2^bits squares of the
    /// direction square (direction_map.h), in row order from v = 0. Per steradian, so the mean over squares is 1 / (4
    /// pi).
    std::vector<float> density_map(std::uint32_t distribution, int bits) const;

    /// The model if it is of type M, else nullptr.
    template <class M>
    const M* get_if() const {
        return std::get_if<M>(&model_);
    }
    /// Calls visit.operator()<G>(model) with the model's guide G.
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
    requires std::derived_from<std::remove_cvref_t<S>, RegionSampler>  // so never an AnySampler: NOLINTNEXTLINE
    AnySampler(S&& sampler) : sampler_(std::forward<S>(sampler)) {}

    GuideKind kind() const { return static_cast<GuideKind>(sampler_.index()); }
    const RegionSampler& regions() const {
        return std::visit([](const RegionSampler& regions) -> const RegionSampler& { return regions; }, sampler_);
    }
    /// The sampler, which must be of type S.
    template <class S>
    const S& get() const {
        if constexpr (std::is_same_v<S, RegionSampler>)
            return regions();
        else
            return std::get<S>(sampler_);
    }
    /// Calls visit.operator()<G>(sampler) with the sampler's guide G.
    template <class Visit>
    decltype(auto) visit(Visit visit) const {
        return std::visit([&]<class S>(const S& sampler) { return visit.template operator()<GuideOf<S>>(sampler); },
                          sampler_);
    }

  private:
    Guides::Samplers sampler_;
};

/// Logs of a work unit's records, of which its guide uses its own.
class AnyLog {
  public:
    template <class G>
    typename StatisticOf<G>::Log& of() {
        return std::get<static_cast<std::size_t>(kind_of<G>())>(logs_);
    }
    template <class G>
    const typename StatisticOf<G>::Log& of() const {
        return std::get<static_cast<std::size_t>(kind_of<G>())>(logs_);
    }
    /// Clears the guide's log, keeping its memory; arguments as of RecordLogOf::begin().
    void begin(GuideKind guide, std::uint32_t distributions, std::uint32_t regions = 0) {
        with_guide(guide, [&]<class G>() { of<G>().begin(distributions, regions); });
    }

  private:
    Guides::Logs logs_;
};

/// Statistic of any guide.
class AnyAccumulator {
  public:
    AnyAccumulator(std::uint32_t pass, const AnySampler& guide, DirectionalFilter filter, bool with_mixture);

    void commit(const AnyLog& log);
    Blocks take();
    void give_back(Blocks cleared);

  private:
    Guides::Accumulators accumulator_;
};

/// Learner of any guide on the coordinator: turns the records of a pass into the model that guides the next. Pure,
/// except for its memory of earlier passes.
class AnyLearner {
  public:
    /// `sums`: blocks of a pass over the model; `learn_mixture`: it recorded for mixtures, too.
    AnyModel learn(const AnyModel& model, Blocks sums, const RefineSettings& settings, bool learn_mixture,
                   RefineReport& report);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        auto kind = static_cast<std::uint8_t>(learner_.index());
        archive(kind);
        if (kind != learner_.index()) forget(kind);
        std::visit([&](auto& learner) { archive(learner); }, learner_);
    }

  private:
    /// Becomes an empty learner of the guide with this number. Throws FormatError if there is none.
    void forget(std::uint8_t kind);

    Guides::Learners learner_;
};

}  // namespace treefarm
