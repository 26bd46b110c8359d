// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "common/base/policy.h"
#include "common/decide/emission/emission_decision.h"
#include "common/decide/guiding/guiding_decision.h"
#include "common/decide/light_subpaths/light_subpath_decision.h"
#include "common/decide/next_event/next_event_decision.h"
#include "common/decide/sample_cost.h"
#include "common/decide/splitting/splitting_decision.h"
#include "common/evidence/blocks.h"
#include "common/evidence/declared_sums.h"

namespace treefarm {

/// Requirements of a decision, by which a finished pass changes later ones. `Evidence` are the sums of a pass that it
/// judges by, a block of the pass's evidence; `Memory` outlives the pass; `Figures` are reported with it. Memory and
/// figures archive themselves, for checkpoints: serialize(), which throws FormatError for values read that no render
/// has.
/// Tables of tuned constants are listed in `kConstants`, if it has any.
template <class D>
concept Decision = DeclaredSums<typename D::Evidence> && std::default_initializable<typename D::Memory> &&
    std::default_initializable<typename D::Figures> &&
    requires(const JudgedPass& pass, const typename D::Evidence& evidence, typename D::Memory& memory,
             typename D::Figures& figures, PassPlan& plan) {
    D::judge(pass, evidence, memory, figures);
    D::apply(plan, std::as_const(memory));
    /// Whether schedule.toml has the result: then a render with --schedule has it from there.
    { D::kScheduled } -> std::convertible_to<bool>;
    /// Figures with name, unit, meaning and value.
    { D::kColumns[0] } -> std::convertible_to<const DecisionColumn<typename D::Figures>&>;
};

/// A part of each decision, in the order of their list.
template <class... Part>
struct DecisionParts {
    std::tuple<Part...> all;

    template <class P>
    P& get() {
        return std::get<P>(all);
    }
    template <class P>
    const P& get() const {
        return std::get<P>(all);
    }
    template <class Archive>
    void serialize(Archive& archive) {
        std::apply([&](auto&... part) { archive(part...); }, all);
    }
    void add(const DecisionParts& other) { (..., get<Part>().add(other.template get<Part>())); }
};

/// List of decisions, which judge a pass in this order.
template <Decision... D>
struct DecisionList {
    using Evidence = DecisionParts<typename D::Evidence...>;
    using Memories = DecisionParts<typename D::Memory...>;
    using Figures = DecisionParts<typename D::Figures...>;

    /// Empty blocks of the decisions.
    static Blocks blocks() {
        static constexpr std::array<BlockShape, sizeof...(D)> kShapes{D::Evidence::kBlock...};
        return Blocks(kShapes);
    }
    /// Adds a pass's sums to the blocks.
    static void put(const Evidence& sums, Blocks& blocks) {
        std::size_t block = 0;
        (..., put_sums(sums.template get<typename D::Evidence>(), blocks.sums(block++)));
    }
    /// Sums of the blocks.
    static Evidence evidence(const Blocks& blocks) {
        std::size_t block = 0;
        return {{sums_of<typename D::Evidence>(blocks.sums(block++))...}};
    }

    static void judge(JudgedPass pass, const Evidence& sums, Memories& memories, Figures& figures) {
        pass.sample_cost = sample_cost(pass.plan, pass.counts);
        const auto judge_one = [&]<class One>() {
            auto& memory = memories.template get<typename One::Memory>();
            One::judge(pass, sums.template get<typename One::Evidence>(), memory,
                       figures.template get<typename One::Figures>());
            One::apply(pass.next, memory);
        };
        (judge_one.template operator()<D>(), ...);
    }

    /// Applies the decisions that schedule.toml has (`scheduled`), or the others, to the plan of the next pass.
    static void apply(PassPlan& plan, const Memories& memories, bool scheduled) {
        (..., (D::kScheduled == scheduled ? D::apply(plan, memories.template get<typename D::Memory>()) : void()));
    }

    /// Tables of tuned constants of all decisions.
    static std::vector<std::span<const policy::Constant>> constants() {
        std::vector<std::span<const policy::Constant>> tables;
        const auto add = [&]<class One>() {
            if constexpr (requires { One::kConstants; })
                tables.insert(tables.end(), std::begin(One::kConstants), std::end(One::kConstants));
        };
        (add.template operator()<D>(), ...);
        return tables;
    }

    /// Columns of all decisions.
    static constexpr auto kFigures = [] {
        std::array<PassFigure, (... + std::size(D::kColumns))> figures{};
        std::size_t next = 0;
        const auto add = [&](const auto& columns) {
            for (const auto& column : columns)
                figures[next++] = column.figure;
        };
        (add(D::kColumns), ...);
        return figures;
    }();

    /// Values of kFigures for a pass.
    static std::vector<FigureValue> values(const PassPlan& plan, const Figures& figures) {
        std::vector<FigureValue> values;
        const auto add = [&]<class One>() {
            for (const auto& column : One::kColumns)
                values.push_back(column.value(plan, figures.template get<typename One::Figures>()));
        };
        (add.template operator()<D>(), ...);
        return values;
    }
};

/// The decisions of the program. Next event depends on the new verdict on guiding.
using Decisions =
    DecisionList<GuidingDecision, NextEventDecision, SplittingDecision, LightSubpathDecision, EmissionDecision>;

}  // namespace treefarm
