// SPDX-License-Identifier: Apache-2.0
#include "worker/pass_work.h"

#include <utility>

#include "common/base/timer.h"
#include "common/evidence/evidence.h"

namespace treefarm {

PassWork::PassWork(const PassPlan& plan, const AnyModel& model, DirectionalFilter filter) : plan_(plan), guide_(model) {
    if (plan_.record) accumulator_.emplace(plan_.index, guide_, filter, plan_.learn_mixture);
}

void PassWork::deliver(const WorkUnit& unit, UnitOutput& output) {
    const std::shared_lock bundle(bundle_);
    if (accumulator_) {
        const double start = thread_cpu_seconds();
        accumulator_->commit(output.log);
        output.stats.splat_seconds += thread_cpu_seconds() - start;
    }
    if (!output.splats.empty()) add_splats(output.splats);
    const std::scoped_lock lock(units_lock_);
    bundle_bytes_ += (output.pixels.size() + output.aovs.direct.size()) * sizeof(PixelEstimate) +
                     output.aovs.values.size() * sizeof(double);
    units_.push_back({unit, std::exchange(output.pixels, {}), std::exchange(output.aovs, {})});
    stats_.add(output.stats);
}

void PassWork::add_splats(SplatLog& log) {
    const auto entries = log.summed();
    const std::scoped_lock lock(splats_lock_);
    if (splats_.shape() != plan_.layers.splats) splats_ = SplatSums(plan_.layers.splats);
    splats_.add(entries, log.caps());
    splatted_ = true;
}

std::optional<Result> PassWork::close() {
    Result result;
    result.pass = plan_.index;
    UnitStats stats;
    std::optional<Blocks> taught;
    {
        const std::unique_lock bundle(bundle_);
        if (units_.empty()) return std::nullopt;
        result.units = std::exchange(units_, {});
        bundle_bytes_ = 0;
        stats = std::exchange(stats_, {});
        if (accumulator_) taught = accumulator_->take();
        if (std::exchange(splatted_, false)) {
            result.splats = splats_.encode();
            splats_.clear();
        }
    }
    Blocks decided = Decisions::blocks();
    Decisions::put(stats.decided, decided);
    std::vector<const Blocks*> owners{&decided};
    if (taught) owners.push_back(&*taught);
    result.evidence = encode_evidence(plan_.index, owners);
    result.stats = std::move(stats);
    if (taught) {
        taught->clear();
        accumulator_->give_back(std::move(*taught));
    }
    return result;
}

}  // namespace treefarm
