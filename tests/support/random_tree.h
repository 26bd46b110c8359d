// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/guiding/sd_tree/sd_tree.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm::test {

/// Records of a synthetic light field in the unit cube: a few narrow and broad lobes whose directions vary with the
/// position.
std::vector<Record> random_records(const RegionSampler& guide, std::size_t count, unsigned seed);

/// Tree that has learned from random_records for `passes` passes.
SdTree random_tree(int passes, std::size_t records_per_pass, double spatial_threshold, unsigned seed);

/// Records as of random_records(), with random outgoing directions: half of them also for the views of their regions.
std::vector<Record> random_view_records(const SdTreeSampler& guide, std::size_t count, unsigned seed);

/// Tree with views that has learned from random_view_records: T2s with more records than `view_set_threshold` are cut,
/// views with more than a quarter of that are split.
SdTree random_view_tree(int passes, std::size_t records_per_pass, double spatial_threshold, double view_set_threshold,
                        unsigned seed);

/// Sums of records.
CellSums sums_of(const SdTreeSampler& guide, std::span<const Record> records);

}  // namespace treefarm::test
