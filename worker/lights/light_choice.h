// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/base/random.h"
#include "common/config/job.h"
#include "worker/lights/discrete_table.h"
#include "worker/lights/light_tree.h"

namespace treefarm {

/// Next event's choice of an emitter among the entries of the table of all (Emitters): by one table for all points, or
/// by the estimated contribution to a point, with learned probabilities (docs/design/lights.md).
class LightChoice {
  public:
    LightChoice() = default;

    /// `power` of each entry; those of 0 are never chosen. `bounds` of each; empty if `how` is a table.
    LightChoice(LightSelection how, std::span<const double> power, std::span<const LightBounds> bounds);

    /// Whether `how` needs bounds.
    static bool by_point(LightSelection how) { return how == LightSelection::tree || how == LightSelection::learned; }

    bool empty() const { return table_.empty(); }
    /// Whether the choice is by power at every point.
    bool by_power() const { return by_power_; }

    /// Chooses by random[0], or by all four numbers, which are then independent of the choice.
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

    /// The choice among few emitters, which may be done in batches; nullptr for other choices.
    const FlatLights* flat() const { return flat_ ? &*flat_ : nullptr; }
    /// Number of nodes of the light tree; 0 if there is none.
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

/// Probabilities of entries, for a density.
struct EntryProbabilities {
    const LightChoice* choice = nullptr;  ///< nullptr: by power
    const LightReceiver* receiver = nullptr;
    LightPick known = {};  ///< an entry whose probability is already known

    bool by_power() const { return choice == nullptr; }
    float operator()(std::uint32_t entry) const {
        return entry == known.entry ? known.probability : choice->probability(entry, *receiver);
    }
};

}  // namespace treefarm
