// SPDX-License-Identifier: Apache-2.0
// Cost of guiding per operation: region look-up, direction sample, density, record, merge, refine. Trees of about 1 MB
// and 32 MB: inside and outside of the cache.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <random>

#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "common/guiding/statistics/cell_accumulator.h"
#include "tests/support/random_tree.h"

namespace treefarm {
namespace {

struct Trained {
    SdTree tree;
    SdTreeSampler guide;
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> regions, codes;
    explicit Trained(int split) : tree(test::random_tree(5, 400000, split, 1)), guide(tree) {
        std::mt19937 engine(7);
        std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
        for (int i = 0; i < 1 << 16; ++i) {
            positions.emplace_back(uniform(engine), uniform(engine), uniform(engine));
            regions.push_back(guide.region(positions.back()));
            codes.push_back(static_cast<std::uint32_t>(engine()));
        }
    }
};

/// Trained tree per size, built once.
const Trained& trained(benchmark::State& state) {
    static std::map<int, std::unique_ptr<Trained>> trees;
    auto& entry = trees[static_cast<int>(state.range(0))];
    if (!entry) entry = std::make_unique<Trained>(static_cast<int>(state.range(0)));
    state.counters["MB"] = static_cast<double>(entry->guide.bytes()) / 1e6;
    state.counters["regions"] = entry->guide.region_count();
    return *entry;
}

void find_region(benchmark::State& state) {
    const Trained& t = trained(state);
    std::size_t i = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(t.guide.region(t.positions[i++ & 0xffff]));
}

void sample_direction(benchmark::State& state) {
    const Trained& t = trained(state);
    std::size_t i = 0;
    for (auto _ : state) {
        const std::size_t k = i++ & 0xffff;
        benchmark::DoNotOptimize(t.guide.sample(t.regions[k], t.codes[k], t.codes[k] * 31, t.codes[k] * 77));
    }
}

void density(benchmark::State& state) {
    const Trained& t = trained(state);
    std::size_t i = 0;
    for (auto _ : state) {
        const std::size_t k = i++ & 0xffff;
        benchmark::DoNotOptimize(t.guide.pdf(t.regions[k], t.codes[k]));
    }
}

void map_direction(benchmark::State& state) {
    const Trained& t = trained(state);
    std::size_t i = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(direction_to_code(normalize(t.positions[i++ & 0xffff])));
}

void commit_records(benchmark::State& state) {
    const Trained& t = trained(state);
    CellAccumulator accumulator(t.tree.pass, t.guide);
    const std::vector<Record> records = test::random_records(t.guide, 80000, 3);
    const std::vector<std::uint32_t> counts(t.guide.region_count(), 1);
    for (auto _ : state) {
        std::vector<Record> copy = records;
        accumulator.commit(copy, counts, {});
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(records.size()));
}

void merge_update(benchmark::State& state) {
    const Trained& t = trained(state);
    CellAccumulator accumulator(t.tree.pass, t.guide);
    std::vector<Record> records = test::random_records(t.guide, 400000, 3);
    accumulator.commit(records, std::vector<std::uint32_t>(t.guide.region_count(), 1), {});
    const Bytes update = accumulator.take().encode();
    CellSums sums(t.tree.pass, t.guide.region_count(), t.guide.cell_count());
    std::uint64_t cells = 0;
    for (auto _ : state)
        cells = sums.merge_encoded(update);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(cells));
    state.counters["bytes/cell"] = static_cast<double>(update.size()) / static_cast<double>(cells);
}

void refine_tree(benchmark::State& state) {
    const Trained& t = trained(state);
    CellAccumulator accumulator(t.tree.pass, t.guide);
    std::vector<Record> records = test::random_records(t.guide, 400000, 3);
    accumulator.commit(records, std::vector<std::uint32_t>(t.guide.region_count(), 1), {});
    const CellSums sums = accumulator.take();
    RefineReport report;
    for (auto _ : state)
        benchmark::DoNotOptimize(refine(t.tree, sums, {.spatial_threshold = 1e9}, report));
    state.SetItemsProcessed(state.iterations() * t.guide.cell_count());
}

BENCHMARK(find_region)->Arg(4000)->Arg(60);
BENCHMARK(sample_direction)->Arg(4000)->Arg(60);
BENCHMARK(density)->Arg(4000)->Arg(60);
BENCHMARK(map_direction)->Arg(4000);
BENCHMARK(commit_records)->Arg(4000)->Arg(60);
BENCHMARK(merge_update)->Arg(4000)->Arg(60);
BENCHMARK(refine_tree)->Arg(4000)->Arg(60)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace treefarm
