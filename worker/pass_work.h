// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <vector>

#include "common/film/splat_film.h"
#include "common/guiding/any_guide.h"
#include "common/protocol/messages.h"
#include "worker/integrators/unit_output.h"

namespace treefarm {

/// State of a worker for one pass: the plan, the guide, and the open bundle of finished units, with the sums of exactly
/// these units' records and splats. Tracing threads deliver units while the communication thread closes bundles.
class PassWork {
  public:
    PassWork(const PassPlan& plan, const AnyModel& model, DirectionalFilter filter);

    const PassPlan& plan() const { return plan_; }
    const AnySampler& guide() const { return guide_; }

    /// Adds a finished unit and its records to the open bundle. Thread-safe; `output` loses its pixels and AOVs, and
    /// its records are reordered.
    void deliver(const WorkUnit& unit, UnitOutput& output);

    /// Closes the bundle and opens a new one; no value if no unit was delivered since the last one. The caller sets the
    /// message's incarnation. Waits for deliveries in progress, not for tracing.
    std::optional<Result> close();

    /// Bytes of the pixels in the open bundle.
    std::size_t bundle_bytes() const { return bundle_bytes_; }

  private:
    void add_splats(SplatLog& log);

    const PassPlan plan_;
    const AnySampler guide_;
    std::shared_mutex bundle_;  ///< shared: adding to the open bundle; exclusive: closing it
    std::mutex units_lock_;
    std::vector<UnitResult> units_;
    std::atomic<std::size_t> bundle_bytes_{0};
    UnitStats stats_;
    std::optional<AnyAccumulator> accumulator_;  ///< in passes that record
    std::mutex splats_lock_;
    SplatSums splats_;  ///< allocated when the first unit splats
    bool splatted_ = false;
};

}  // namespace treefarm
