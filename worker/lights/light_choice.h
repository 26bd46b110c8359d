// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/base/random.h"
#include "common/config/job.h"
#include "worker/lights/discrete_table.h"
#include "worker/lights/light_tree.h"

namespace treefarm {

/// The choice of an emitter by next event, among the entries of the table of all (Emitters): by a table that is the
/// same everywhere, or by what each brings to a point, with what is learned there (docs/design/lights.md).
class LightChoice {
  public:
    LightChoice() = default;

    /// `power` of each entry: those of 0 are never chosen. `bounds` of each; empty, where `how` is a table.
    LightChoice(LightSelection how, std::span<const double> power, std::span<const LightBounds> bounds);

    /// Whether `how` needs bounds.
    static bool by_point(LightSelection how) { return how == LightSelection::tree || how == LightSelection::learned; }

    bool empty() const { return table_.empty(); }
    /// Whether it is that by power, everywhere.
    bool by_power() const { return by_power_; }

    /// Chooses by random[0], or by all four numbers: then none tells anything of which emitter it was.
    LightPick pick(const Draw& random, const LightReceiver& receiver) const {
        if (by_point_) [[unlikely]]
            return pick_by_point(random, receiver);
        const std::uint32_t entry = table_.pick(random[0]);
        return {entry, table_.probability(entry)};
    }

    /// Probability with which pick() chooses an entry.
    float probability(std::uint32_t entry, const LightReceiver& receiver) const {
        return by_point_ ? probability_by_point(entry, receiver) : table_.probability(entry);
    }

    /// The choice among few, which many points make together; nullptr where it is another.
    const FlatLights* flat() const { return flat_ ? &*flat_ : nullptr; }
    /// Nodes and bytes of the hierarchy; 0 where there is none.
    std::size_t node_count() const { return tree_ ? tree_->node_count() : 0; }
    std::size_t bytes() const { return tree_ ? tree_->bytes() : 0; }

  private:
    [[gnu::noinline]] LightPick pick_by_point(const Draw& random, const LightReceiver& receiver) const;
    [[gnu::noinline]] float probability_by_point(std::uint32_t entry, const LightReceiver& receiver) const;

    DiscreteTable table_;
    bool by_power_ = true, by_point_ = false;
    std::optional<FlatLights> flat_;
    std::optional<LightTree> tree_;
};

/// Probabilities of entries where a density is asked for.
struct EntryProbabilities {
    const LightChoice* choice = nullptr;  ///< nullptr: by power
    const LightReceiver* receiver = nullptr;
    LightPick known = {};  ///< of an entry of which it is known already

    bool by_power() const { return choice == nullptr; }
    float operator()(std::uint32_t entry) const {
        return entry == known.entry ? known.probability : choice->probability(entry, *receiver);
    }
};

}  // namespace treefarm
