// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/any_guide.h"

#include <optional>

#include "common/guiding/regions/cell_shape.h"
#include "common/math/direction_map.h"

namespace treefarm {
namespace {

/// Density on a grid of 2^bits by 2^bits squares, each the mean over the centres of its 4 by 4 parts.
template <class Sampler>
std::vector<float> sampled_map(const Sampler& guide, std::uint32_t region, int bits) {
    constexpr std::uint32_t kParts = 4;
    const std::uint32_t side = 1u << bits;
    const auto at = [&](std::uint32_t square, std::uint32_t part) {
        return (static_cast<float>(square) + (static_cast<float>(part) + 0.5f) / kParts) / static_cast<float>(side);
    };
    std::vector<float> density;
    for (std::uint32_t row = 0; row < side; ++row)
        for (std::uint32_t column = 0; column < side; ++column) {
            double sum = 0;
            for (std::uint32_t part = 0; part < kParts * kParts; ++part)
                sum += double(guide.pdf(region, square_to_code({at(column, part % kParts), at(row, part / kParts)})));
            density.push_back(static_cast<float>(sum / (kParts * kParts)));
        }
    return density;
}

}  // namespace

AnyModel AnyModel::first(GuideKind kind, const Box3& bounds, const FirstModel& settings) {
    AnyModel model;
    with_guide(kind, [&]<class G>() { model = G::first(bounds, settings); });
    return model;
}

AnyModel AnyModel::decode(std::span<const std::uint8_t> bytes) {
    const auto magic = ByteReader(bytes).get<std::uint32_t>();
    std::optional<AnyModel> model;
    Guides::find([&]<class G>() {
        if (magic == G::kMagic) model = G::decode(bytes);
        return model.has_value();
    });
    if (!model) throw FormatError("not a Treefarm tree");
    return std::move(*model);
}

Bytes AnyModel::encode() const {
    return visit([]<class G>(const auto& model) { return G::encode(model); });
}

const RegionModel& AnyModel::regions() const {
    return std::visit([](const RegionModel& regions) -> const RegionModel& { return regions; }, model_);
}

void AnyModel::set_pass(std::uint32_t pass) {
    std::visit([&](RegionModel& regions) { regions.pass = pass; }, model_);
}

void AnyModel::set_learns_lights(bool learns) {
    std::visit(
        [&](RegionModel& regions) {
            if (!learns) regions.light_probabilities.clear();
            if (learns && !regions.learns_lights())
                regions.light_probabilities.assign(regions.leaf_count(), kNothingLearned);
        },
        model_);
}

void AnyModel::set_decides_next_event(bool decides) {
    std::visit(
        [&](RegionModel& regions) {
            if (!decides) regions.next_event.clear();
            if (decides && !regions.decides_next_event()) regions.next_event.assign(regions.leaf_count(), 0);
        },
        model_);
}

void AnyModel::set_image(ImageFacts image) {
    std::visit([&](RegionModel& regions) { regions.image = std::move(image); }, model_);
}

ModelFigures AnyModel::figures() const {
    return visit([]<class G>(const auto& model) { return G::figures(model); });
}

SamplerCost AnyModel::cost() const {
    return visit([]<class G>(const auto&) { return G::kCost; });
}

bool AnyModel::grows() const {
    return visit([]<class G>(const auto&) { return G::kGrows; });
}

namespace {

/// Shape of the sums of a pass over a model of guide `G`.
template <class G, class Model>
typename StatisticOf<G>::Shape shape_of(const Model& model, bool with_mixture) {
    if constexpr (requires { typename G::Statistic; })
        return G::Statistic::shape(model, with_mixture);
    else
        return cell_shape<G>(model, with_mixture);
}

}  // namespace

Blocks AnyModel::blocks(std::uint32_t pass, bool with_mixture) const {
    return visit([&]<class G>(const auto& model) {
        return typename StatisticOf<G>::Sums(pass, shape_of<G>(model, with_mixture)).take_blocks();
    });
}

UpdateCaps AnyModel::caps(const Blocks& blocks) const {
    return visit([&]<class G>(const auto&) { return StatisticOf<G>::Sums::caps_of(blocks); });
}

TreeStatistics AnyModel::statistics(std::uint64_t encoded_bytes) const {
    return visit([&]<class G>(const auto& model) {
        TreeStatistics statistics;
        if constexpr (requires { G::statistics(model); })
            statistics = G::statistics(model);
        else
            statistics = even_statistics(model, G::figures(model));
        statistics.encoded_bytes = encoded_bytes;
        statistics.memory_bytes = typename G::Sampler(model).bytes();
        return statistics;
    });
}

std::vector<double> AnyModel::cells_by_region() const {
    return visit([&]<class G>(const auto& model) {
        if constexpr (requires { G::cells_by_region(model); }) return G::cells_by_region(model);
        const std::size_t regions = model.leaf_count();
        return std::vector<double>(regions, static_cast<double>(G::figures(model).cells) / double(regions));
    });
}

std::vector<float> AnyModel::density_map(std::uint32_t distribution, int bits) const {
    return visit([&]<class G>(const auto& model) {
        if constexpr (requires { G::density_map(model, distribution, bits); })
            return G::density_map(model, distribution, bits);
        else
            return sampled_map(typename G::Sampler(model), distribution, bits);
    });
}

AnySampler::AnySampler(const AnyModel& model)
    : sampler_(model.visit([]<class G>(const auto& of_guide) -> Guides::Samplers {
          return Guides::Samplers(std::in_place_type<typename G::Sampler>, of_guide);
      })) {}

AnyAccumulator::AnyAccumulator(std::uint32_t pass, const AnySampler& guide, DirectionalFilter filter,
                               bool with_mixture) {
    guide.visit([&]<class G>(const auto& sampler) {
        accumulator_.template emplace<1 + static_cast<std::size_t>(kind_of<G>())>(pass, sampler, filter, with_mixture);
    });
}

namespace {

/// Calls use(accumulator) for the accumulator that is set. The result type is explicit, since clang 14 crashes where it
/// has to deduce it.
template <class Result, class Accumulators, class Use>
Result with_accumulator(Accumulators& accumulators, Use use) {
    return std::visit(
        [&]<class A>(A& accumulator) -> Result {
            if constexpr (std::is_same_v<A, std::monostate>)
                throw RunError("no guide's records are added");
            else
                return use(accumulator);
        },
        accumulators);
}

}  // namespace

void AnyAccumulator::commit(const AnyLog& log) {
    const bool found = Guides::find([&]<class G>() {
        auto* const accumulator = std::get_if<1 + static_cast<std::size_t>(kind_of<G>())>(&accumulator_);
        if (accumulator) accumulator->commit(log.of<G>());
        return accumulator != nullptr;
    });
    if (!found) throw RunError("no guide's records are added");
}

Blocks AnyAccumulator::take() {
    return with_accumulator<Blocks>(accumulator_, [](auto& accumulator) { return accumulator.take().take_blocks(); });
}

void AnyAccumulator::give_back(Blocks cleared) {
    with_accumulator<void>(accumulator_, [&](auto& accumulator) { accumulator.give_back(std::move(cleared)); });
}

AnyModel AnyLearner::learn(const AnyModel& model, Blocks sums, const RefineSettings& settings, bool learn_mixture,
                           RefineReport& report) {
    return model.visit([&]<class G>(const auto& of_guide) -> AnyModel {
        using Learner = typename G::Learner;
        if (!std::holds_alternative<Learner>(learner_)) learner_.template emplace<Learner>();
        const typename StatisticOf<G>::Sums named(of_guide.pass, shape_of<G>(of_guide, learn_mixture), std::move(sums));
        return std::get<Learner>(learner_).learn(of_guide, named, settings, learn_mixture, report);
    });
}

void AnyLearner::forget(std::uint8_t kind) {
    int index = 0;
    const bool found = Guides::find([&]<class G>() {
        if (index++ != kind) return false;
        learner_.template emplace<typename G::Learner>();
        return true;
    });
    if (!found) throw FormatError("the memory of an unknown guide");
}

}  // namespace treefarm
