// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree/refine_views.h"

#include <algorithm>

namespace treefarm {
namespace {

class ViewRefiner {
  public:
    ViewRefiner(const SdTree& tree, const CellSums& sums, const RefineSettings& settings,
                std::span<const ViewAdvice> advice, SdTree& refined, RefineReport& report)
        : old_(tree),
          sums_(sums),
          settings_(settings),
          advice_(advice),
          result_(refined),
          report_(report),
          sets_(tree.view_set_count()),
          refined_(tree.view_count()),
          splits_(tree.view_count()) {}

    void run() {
        limit_ = std::max(settings_.view_cells * static_cast<double>(result_.cell_count()), settings_.least_view_cells);
        find_common_sets(0);
        choose_kept();
        choose_cuts();
        choose_splits();
        if (std::none_of(sets_.begin(), sets_.end(), [](const Set& set) { return set.kept; })) return;
        result_.view_set.assign(result_.region_count(), SdTree::kNoViews);
        result_.view_begin.push_back(0);
        for_parts([&](std::uint32_t set, std::uint32_t first, std::uint32_t end, int cuts) {
            add_part(set, first, end, cuts);
        });
    }

  private:
    /// A T2 of the old tree.
    struct Set {
        double records = 0;  ///< weighted
        double gain = 0;
        double cells = 0;         ///< refined, before views split
        std::uint32_t root = 0;   ///< lowest node of the refined tree above all its regions
        std::uint32_t parts = 0;  ///< number of parts that it is cut into
        double threshold = 0;     ///< weighted records above which it is cut
        bool kept = false;
    };
    /// A node of the refined tree: the T2 that all regions below it share, and their number.
    struct Below {
        std::uint32_t set = SdTree::kNoViews;
        std::uint32_t regions = 1;
    };
    static constexpr std::uint32_t kMixed = SdTree::kNoViews - 1;
    struct Choice {
        std::uint32_t index;
        double gain;  ///< relative to its cells
    };

    double gain(std::uint32_t view) const { return advice_.empty() ? 0.0 : advice_[view].gain; }
    double records(std::uint32_t view) const {
        return static_cast<double>(sums_.counts()[old_.region_count() + view]) * settings_.record_weight;
    }
    double cells_of(std::uint32_t view) const { return static_cast<double>(refined_[view].directions.depth.size()); }

    /// Reserves `cells` more if the limit allows it.
    bool take(double cells) {
        if (taken_ + cells > limit_) return false;
        taken_ += cells;
        return true;
    }

    static void sort_by_gain(std::vector<Choice>& choices) {
        std::stable_sort(choices.begin(), choices.end(),
                         [](const Choice& a, const Choice& b) { return a.gain > b.gain; });
    }

    Below find_common_sets(std::uint32_t node) {
        below_.resize(result_.nodes.size());
        const SdTree::Node& n = result_.nodes[node];
        if (n.is_leaf()) {
            below_[node] = {old_.view_set[report_.origins[n.child[1]].region], 1};
        } else {
            const Below low = find_common_sets(n.child[0]), high = find_common_sets(n.child[1]);
            below_[node] = {low.set == high.set ? low.set : kMixed, low.regions + high.regions};
        }
        // The last node to set this is the highest.
        if (below_[node].set < sets_.size()) sets_[below_[node].set].root = node;
        return below_[node];
    }

    /// Number of parts of a T2 cut by this threshold.
    std::uint32_t part_count(std::uint32_t node, double weight, double threshold) const {
        const SdTree::Node& n = result_.nodes[node];
        if (n.is_leaf() || !(weight > threshold)) return 1;
        return part_count(n.child[0], weight / 2, threshold) + part_count(n.child[1], weight / 2, threshold);
    }

    /// Calls visit(T2 of the old tree, first and end of the regions, halvings) for each part of a kept T2, in the order
    /// of regions.
    template <class Visit>
    void for_parts(Visit visit) const {
        for_parts(0, 0, visit);
    }

    template <class Visit>
    void for_parts(std::uint32_t node, std::uint32_t first, Visit& visit) const {
        const std::uint32_t set = below_[node].set;
        if (set == kMixed) {
            const SdTree::Node& n = result_.nodes[node];
            for_parts(n.child[0], first, visit);
            for_parts(n.child[1], first + below_[n.child[0]].regions, visit);
        } else if (set != SdTree::kNoViews && sets_[set].kept) {
            cut(node, first, sets_[set].records, 0, visit);
        }
    }

    template <class Visit>
    void cut(std::uint32_t node, std::uint32_t first, double weight, int cuts, Visit& visit) const {
        const SdTree::Node& n = result_.nodes[node];
        const auto [set, regions] = below_[node];
        if (n.is_leaf() || !(weight > sets_[set].threshold)) return visit(set, first, first + regions, cuts);
        cut(n.child[0], first, weight / 2, cuts + 1, visit);
        cut(n.child[1], first + below_[n.child[0]].regions, weight / 2, cuts + 1, visit);
    }

    void choose_kept() {
        std::vector<Choice> choices;
        for (std::uint32_t t = 0; t < sets_.size(); ++t) {
            Set& set = sets_[t];
            bool keep = advice_.empty();
            for (std::uint32_t v = old_.view_begin[t]; v < old_.view_begin[t + 1]; ++v) {
                set.records += records(v);
                set.gain += gain(v);
                keep |= !advice_.empty() && advice_[v].keep;
            }
            if (!(set.records > 0) || !keep) continue;
            for (std::uint32_t v = old_.view_begin[t]; v < old_.view_begin[t + 1]; ++v) {
                refined_[v] = refine_distribution(old_, sums_, old_.region_count() + v, settings_, report_);
                set.cells += cells_of(v);
            }
            choices.push_back({t, set.gain / set.cells});
        }
        sort_by_gain(choices);
        for (const Choice& choice : choices)
            sets_[choice.index].kept = take(sets_[choice.index].cells);
    }

    /// Cuts the kept T2s into as many parts as the limit of cells allows.
    void choose_cuts() {
        std::vector<Choice> choices;
        for (std::uint32_t t = 0; t < sets_.size(); ++t) {
            Set& set = sets_[t];
            if (!set.kept) continue;
            set.threshold = settings_.view_set_threshold;
            set.parts = part_count(set.root, set.records, set.threshold);
            choices.push_back({t, set.gain / (set.cells * set.parts)});
        }
        sort_by_gain(choices);
        for (const Choice& choice : choices) {
            Set& set = sets_[choice.index];
            while (!take(set.cells * (set.parts - 1))) {
                set.threshold = std::max(2 * set.threshold, 1.0);
                set.parts = part_count(set.root, set.records, set.threshold);
            }
        }
    }

    void choose_splits() {
        std::vector<Choice> choices;
        std::vector<double> cells(old_.view_count());
        for (std::uint32_t t = 0; t < sets_.size(); ++t) {
            if (!sets_[t].kept) continue;
            // Parts share the records; the published method does not count them as shared.
            const double parts = sets_[t].parts, parts_counted = settings_.views_record_alone ? 1.0 : parts;
            for (std::uint32_t v = old_.view_begin[t]; v < old_.view_begin[t + 1]; ++v) {
                if (!(records(v) > settings_.view_threshold * parts_counted)) continue;
                if (!advice_.empty() && !(gain(v) > 0)) continue;
                if (old_.view_depth[v] == kMaxViewDepth) {
                    ++report_.views_capped;
                    continue;
                }
                cells[v] = 3.0 * cells_of(v) * parts;
                choices.push_back({v, gain(v) / cells[v]});
            }
        }
        sort_by_gain(choices);
        for (const Choice& choice : choices) {
            splits_[choice.index] = take(cells[choice.index]);
            report_.views_capped += !splits_[choice.index];
        }
    }

    void add_part(std::uint32_t set, std::uint32_t first, std::uint32_t end, int cuts) {
        std::fill(result_.view_set.begin() + first, result_.view_set.begin() + end, result_.view_set_count());
        for (std::uint32_t v = old_.view_begin[set]; v < old_.view_begin[set + 1]; ++v)
            for (int part = 0; part < (splits_[v] ? 4 : 1); ++part)
                add_view(v, cuts);
        result_.view_begin.push_back(result_.view_count());
    }

    void add_view(std::uint32_t view, int cuts) {
        add_distribution(result_, refined_[view], old_.bsdf_fraction[old_.region_count() + view]);
        result_.view_depth.push_back(static_cast<std::uint8_t>(old_.view_depth[view] + (splits_[view] ? 1 : 0)));
        result_.view_fraction.push_back(old_.view_fraction[view]);
        report_.view_origins.push_back({view, cuts + (splits_[view] ? 2 : 0)});
    }

    const SdTree& old_;
    const CellSums& sums_;
    const RefineSettings& settings_;
    std::span<const ViewAdvice> advice_;
    SdTree& result_;
    RefineReport& report_;
    std::vector<Set> sets_;
    std::vector<RefinedDistribution> refined_;  ///< per old view
    std::vector<bool> splits_;                  ///< per old view
    std::vector<Below> below_;
    double limit_ = 0, taken_ = 0;
};

}  // namespace

void refine_views(const SdTree& tree, const CellSums& sums, const RefineSettings& settings,
                  std::span<const ViewAdvice> advice, SdTree& refined, RefineReport& report) {
    ViewRefiner(tree, sums, settings, advice, refined, report).run();
}

}  // namespace treefarm
