#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/guide.h"
#include "common/guiding/sd_tree.h"
#include "common/guiding/tree_update.h"

namespace treefarm::test {

/// Records of a made-up light field in the unit cube: a few narrow and broad lobes whose directions move with the
/// position.
std::vector<Record> random_records(const Guide& guide, std::size_t count, unsigned seed);

/// A tree that has learned from random_records for `passes` passes.
SdTree random_tree(int passes, std::size_t records_per_pass, double spatial_threshold, unsigned seed);

}  // namespace treefarm::test
