// SPDX-License-Identifier: Apache-2.0
#include "tests/support/random_tree.h"

#include <random>

#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/statistics/cell_accumulator.h"
#include "common/math/frame.h"
#include "common/math/warp.h"

namespace treefarm::test {

std::vector<Record> random_records(const RegionSampler& guide, std::size_t count, unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::vector<Record> records(count);
    for (Record& record : records) {
        const Vec3 position(uniform(engine), uniform(engine), uniform(engine));
        const float width = uniform(engine) < 0.5f ? 0.3f : 0.001f;
        const Frame lobe(normalize(position - Vec3(0.4f, 0.6f, 1.5f)));
        const Vec3 direction = lobe.to_world(square_to_cone({uniform(engine), uniform(engine)}, width));
        const std::uint32_t region = guide.region(position);
        record = {region,
                  direction_to_code(direction),
                  static_cast<std::uint32_t>(engine()),
                  -std::log(1.0f - uniform(engine)),
                  0.0f,
                  0,
                  true};
    }
    return records;
}

SdTree random_tree(int passes, std::size_t records_per_pass, double spatial_threshold, unsigned seed) {
    SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    for (int pass = 0; pass < passes; ++pass) {
        const SdTreeSampler guide(tree);
        CellAccumulator accumulator(tree.pass, guide);
        std::vector<Record> records = random_records(guide, records_per_pass, seed + static_cast<unsigned>(pass));
        std::vector<std::uint32_t> counts(guide.region_count());
        for (const Record& record : records)
            ++counts[record.distribution];
        accumulator.commit(records, counts, {});
        RefineReport report;
        tree = refine(tree, accumulator.take(), {.spatial_threshold = spatial_threshold}, report);
    }
    return tree;
}

std::vector<Record> random_view_records(const SdTreeSampler& guide, std::size_t count, unsigned seed) {
    std::vector<Record> records = random_records(guide, count, seed);
    std::mt19937 engine(seed + 1000);
    for (std::size_t i = 0; i + 1 < count; i += 2) {
        const std::uint32_t view = guide.view(records[i].distribution, static_cast<std::uint32_t>(engine()));
        if (view == SdTreeSampler::kNoView) continue;
        records[i + 1] = records[i];
        records[i + 1].distribution = view;
    }
    return records;
}

CellSums sums_of(const SdTreeSampler& guide, std::span<const Record> records) {
    CellAccumulator accumulator(0, guide);
    std::vector<std::uint32_t> counts(guide.distribution_count());
    for (const Record& record : records)
        ++counts[record.distribution];
    accumulator.commit(records, counts, {});
    return accumulator.take();
}

SdTree random_view_tree(int passes, std::size_t records_per_pass, double spatial_threshold, double view_set_threshold,
                        unsigned seed) {
    SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), {1.0f, 0.5f, true, 0.25f});
    for (int pass = 0; pass < passes; ++pass) {
        const SdTreeSampler guide(tree);
        const auto records = random_view_records(guide, records_per_pass, seed + static_cast<unsigned>(pass));
        RefineReport report;
        tree = refine(tree, sums_of(guide, records),
                      {.spatial_threshold = spatial_threshold,
                       .view_threshold = view_set_threshold / 4,
                       .view_set_threshold = view_set_threshold},
                      report);
        tree.pass = 0;
    }
    return tree;
}

}  // namespace treefarm::test
