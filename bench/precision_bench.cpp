// SPDX-License-Identifier: Apache-2.0
// Cost and benefit of exactness: integer sums against floats, integer probability tables against floats. Names are
// CHOICE/WITH/...: the first of a choice is the renderer's method (docs/generated/cost-of-accuracy.md reads them).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <random>

#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "common/guiding/statistics/cell_accumulator.h"
#include "tests/support/random_tree.h"

namespace treefarm {
namespace {

constexpr int kSplit = 1000;  ///< a tree of about 5 MB
constexpr std::size_t kRecords = 80000;

struct Trained {
    SdTree tree = test::random_tree(5, 400000, kSplit, 1);
    SdTreeSampler guide = SdTreeSampler(tree);
    std::vector<Record> records = test::random_records(guide, kRecords, 3);
    std::vector<std::uint32_t> counts = std::vector<std::uint32_t>(guide.region_count(), 1);
};

const Trained& trained() {
    static const Trained all;
    return all;
}

/// CellAccumulator with float sums: records sorted by region, a lock per stripe of regions, one float per cell.
class FloatSums {
  public:
    FloatSums(const SdTreeSampler& guide) : guide_(guide), cells_(guide.cell_count()), counts_(guide.region_count()) {}

    void commit(std::span<const Record> records, std::span<const std::uint32_t> counts) {
        std::vector<std::uint32_t> next(counts.size() + 1);
        for (const Record& record : records)
            ++next[record.distribution + 1];
        for (std::size_t r = 0; r < counts.size(); ++r)
            next[r + 1] += next[r];
        std::vector<Record> sorted(records.size());
        for (const Record& record : records)
            sorted[next[record.distribution]++] = record;
        const std::size_t stripe_size = (counts.size() + kStripes - 1) / kStripes;
        const Record* record = sorted.data();
        const Record* const end = record + sorted.size();
        for (std::size_t begin = 0, stripe = 0; begin < counts.size(); begin += stripe_size, ++stripe) {
            const std::size_t stop = std::min(begin + stripe_size, counts.size());
            const std::lock_guard lock(locks_[stripe]);
            for (std::size_t r = begin; r < stop; ++r)
                counts_[r] += static_cast<float>(counts[r]);
            for (; record != end && record->distribution < stop; ++record)
                cells_[guide_.cell(record->distribution, record->code)] += record->value;
        }
    }

    const std::vector<float>& cells() const { return cells_; }

  private:
    static constexpr std::size_t kStripes = 64;
    const SdTreeSampler& guide_;
    std::vector<float> cells_, counts_;
    std::array<std::mutex, kStripes> locks_;
};

void sums_exact(benchmark::State& state) {
    const Trained& t = trained();
    CellAccumulator sums(t.tree.pass, t.guide);
    for (auto _ : state)
        sums.commit(t.records, t.counts, {});
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kRecords));
    state.counters["cells_that_order_changes"] = 0;
    state.counters["bytes_per_cell"] = sizeof(std::uint64_t);
}

/// Fraction of the touched cells whose bits depend on the order in which two workers' records arrive.
double order_dependence(const Trained& t) {
    std::vector<Record> backwards(t.records.rbegin(), t.records.rend());
    FloatSums a(t.guide), b(t.guide);
    a.commit(t.records, t.counts);
    b.commit(backwards, t.counts);
    double touched = 0, differ = 0;
    for (std::size_t c = 0; c < a.cells().size(); ++c) {
        touched += a.cells()[c] > 0;
        differ += a.cells()[c] != b.cells()[c];
    }
    return differ / touched;
}

void sums_float(benchmark::State& state) {
    const Trained& t = trained();
    FloatSums sums(t.guide);
    for (auto _ : state)
        sums.commit(t.records, t.counts);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kRecords));
    state.counters["cells_that_order_changes"] = order_dependence(t);
    state.counters["bytes_per_cell"] = sizeof(float);
}

/// One region's directions by a cumulative table of another number type, searched as in SdTreeSampler: 64 look-up
/// entries, then a search without branches.
template <class Mass>
class Table {
  public:
    struct Cell {
        std::uint32_t code_begin;
        Mass mass_begin;
    };

    Table(const SdTree& tree, std::uint32_t region, Mass whole) : whole_(whole) {
        std::uint64_t code = 0, mass = 0;
        const auto add = [&] {
            const double fraction = std::ldexp(static_cast<double>(mass), -kMassBits);
            cells_.push_back(
                {static_cast<std::uint32_t>(code), static_cast<Mass>(fraction * static_cast<double>(whole))});
        };
        for (std::uint32_t c = tree.cell_begin[region]; c < tree.cell_begin[region + 1]; ++c) {
            add();
            code += std::uint64_t{1} << (2 * (kDirectionBits - tree.cell_depth[c]));
            mass += tree.cell_mass[c];
        }
        add();
        for (std::uint32_t k = 0; k <= kLookupSize; ++k) {
            const auto key = static_cast<Mass>(static_cast<double>(whole) * k / kLookupSize);
            std::uint32_t at = 0;
            while (at + 2 < cells_.size() && cells_[at + 1].mass_begin <= key)
                ++at;
            lookup_[k] = at;
        }
    }

    /// First code of the picked cell, and the cell's probability.
    std::pair<std::uint32_t, float> sample(std::uint32_t pick) const {
        const std::uint32_t entry = pick >> 26;
        const Mass key = key_of(pick);
        const Cell* at = &cells_[lookup_[entry]];
        for (std::uint32_t count = lookup_[entry + 1] - lookup_[entry] + 1; count > 1; count -= count / 2)
            at += at[count / 2].mass_begin <= key ? count / 2 : 0;
        return {at->code_begin, static_cast<float>(at[1].mass_begin - at[0].mass_begin) / static_cast<float>(whole_)};
    }

    /// Largest relative error of a cell's probability, and the fraction of cells that wrongly have probability 0.
    std::pair<double, double> errors(const SdTree& tree, std::uint32_t region) const {
        double worst = 0, lost = 0, all = 0;
        for (std::uint32_t c = tree.cell_begin[region], k = 0; c < tree.cell_begin[region + 1]; ++c, ++k) {
            const double exact = std::ldexp(static_cast<double>(tree.cell_mass[c]), -kMassBits);
            if (!(exact > 0)) continue;
            const double here =
                (static_cast<double>(cells_[k + 1].mass_begin) - static_cast<double>(cells_[k].mass_begin)) /
                static_cast<double>(whole_);
            worst = std::max(worst, std::abs(here / exact - 1));
            lost += !(here > 0);
            ++all;
        }
        return {worst, lost / all};
    }

  private:
    static constexpr std::uint32_t kLookupSize = 64;

    Mass key_of(std::uint32_t pick) const {
        if constexpr (std::is_floating_point_v<Mass>)
            return static_cast<Mass>(pick >> 8) * static_cast<Mass>(0x1p-24);
        else
            return static_cast<Mass>((std::uint64_t{pick} * whole_) >> 32);
    }

    Mass whole_;
    std::vector<Cell> cells_;
    std::array<std::uint32_t, kLookupSize + 2> lookup_{};
};

template <class Mass>
void tables(benchmark::State& state, Mass whole) {
    const Trained& t = trained();
    static const std::vector<Table<Mass>> all = [&] {
        std::vector<Table<Mass>> made;
        for (std::uint32_t r = 0; r < t.guide.region_count(); ++r)
            made.emplace_back(t.tree, r, whole);
        return made;
    }();
    std::mt19937 engine(5);
    std::vector<std::uint32_t> picks(1 << 16);
    for (std::uint32_t& pick : picks)
        pick = static_cast<std::uint32_t>(engine());
    std::size_t i = 0;
    for (auto _ : state) {
        const std::uint32_t pick = picks[i++ & 0xffff];
        benchmark::DoNotOptimize(all[(pick * 2654435761u) % all.size()].sample(pick));
    }
    state.SetItemsProcessed(state.iterations());
    double worst = 0, lost = 0;
    for (std::uint32_t r = 0; r < t.guide.region_count(); ++r) {
        const auto [error, fraction] = all[r].errors(t.tree, r);
        worst = std::max(worst, error);
        lost += fraction / t.guide.region_count();
    }
    state.counters["worst_density_error"] = worst;
    state.counters["cells_lost"] = lost;
    state.counters["bytes_per_cell"] = sizeof(typename Table<Mass>::Cell);
}

BENCHMARK(sums_exact)->Name("sums of records/exact 64-bit integers")->Unit(benchmark::kMillisecond);
BENCHMARK(sums_float)->Name("sums of records/floats")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tables, integers, std::uint32_t{1u << kMassBits})->Name("probability tables/30-bit integers");
BENCHMARK_CAPTURE(tables, words, std::uint16_t{0xffff})->Name("probability tables/16-bit integers");
BENCHMARK_CAPTURE(tables, floats, 1.0f)->Name("probability tables/floats");
BENCHMARK_CAPTURE(tables, doubles, 1.0)->Name("probability tables/doubles");

}  // namespace
}  // namespace treefarm
