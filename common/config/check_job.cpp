#include "common/config/check_job.h"

#include "common/base/error.h"

namespace treefarm {

void check_job(const Job& job) {
    const int max_depth = job.integrator.max_depth, rr_depth = job.integrator.rr_depth;
    if (max_depth < 0 && rr_depth > kLatestRoulette)
        throw InputError(
            Location{"integrator.rr_depth", 0, 0},
            "paths without a depth limit play roulette from depth " + std::to_string(rr_depth) +
                " only: in a closed scene they would not end",
            "set integrator.max_depth, or integrator.rr_depth to at most " + std::to_string(kLatestRoulette));
}

}  // namespace treefarm
