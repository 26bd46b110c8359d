// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/guides/beside_walk.h"
#include "worker/guides/plain_walk.h"
#include "worker/guides/qtable_walk.h"
#include "worker/guides/sd_tree_walk.h"

namespace treefarm {

/// Path-walk adapter of a guide, by the type of its sampler: PlainWalk unless it has an adapter of its own.
template <class Sampler>
struct WalkOfSampler {
    using type = PlainWalk<Sampler>;
};
template <>
struct WalkOfSampler<SdTreeSampler> {
    using type = SdTreeWalk<true>;
};
template <>
struct WalkOfSampler<QTableSampler> {
    using type = QTableWalk;
};
template <class A, class B>
struct WalkOfSampler<BesideSampler<A, B>> {
    using type = BesideWalk<typename WalkOfSampler<typename A::Sampler>::type, BesideSampler<A, B>>;
};
template <class Sampler>
using WalkOf = typename WalkOfSampler<Sampler>::type;

}  // namespace treefarm
