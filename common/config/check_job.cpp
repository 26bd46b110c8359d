// SPDX-License-Identifier: Apache-2.0
#include "common/config/check_job.h"

#include "common/base/error.h"
#include "common/config/aov_list.h"
#include "common/config/estimators.h"

namespace treefarm {

void check_job(const Job& job) {
    const int max_depth = job.integrator.max_depth, rr_depth = job.integrator.rr_depth;
    if (max_depth < 0 && rr_depth > kLatestRoulette)
        throw InputError(
            Location{"integrator.rr_depth", 0, 0},
            "paths without a depth limit play roulette from depth " + std::to_string(rr_depth) +
                " only: in a closed scene they would not end",
            "set integrator.max_depth, or integrator.rr_depth to at most " + std::to_string(kLatestRoulette));
    if (const Estimator* estimator = find_estimator(job.integrator.type);
        estimator && estimator->by_numbers && job.integrator.emitter_samples + job.integrator.bsdf_samples == 0)
        throw InputError(Location{"integrator.emitter_samples", 0, 0},
                         "neither emitters nor BSDFs are sampled: there is no light",
                         "set integrator.emitter_samples or integrator.bsdf_samples to 1 or more");
    if (const Estimator* estimator = find_estimator(job.integrator.type); estimator && !estimator->guides) {
        if (job.guiding.type != GuidingType::none && job.guiding.type != GuidingType::automatic)
            throw InputError(
                Location{"guiding.type", 0, 0}, "nothing guides the estimator \"" + job.integrator.type + "\"",
                std::string(R"(set guiding.type = "none", or integrator.type = ")") + estimators()[0].type + "\"");
    }
    if (const Estimator* estimator = find_estimator(job.integrator.type);
        estimator && estimator->from_lights && !job.output.aovs.empty())
        throw InputError(Location{"output.aovs", 0, 0},
                         "the estimator \"" + job.integrator.type +
                             "\" traces no ray from the camera, so it knows nothing of what is seen there",
                         std::string("set output.aovs = \"\", or integrator.type = \"") + estimators()[0].type + "\"");
    if (const Estimator* estimator = find_estimator(job.integrator.type); estimator && !estimator->sees_light)
        for (const AovRequest& request : aov_requests(job))
            if (request.aov == Aov::direct || request.aov == Aov::indirect)
                throw InputError(Location{"output.aovs", 0, 0},
                                 "the estimator \"" + job.integrator.type + "\" sees no light, direct or indirect",
                                 "leave \"" + aov_text(request) + "\" out of output.aovs");
    if (job.guiding.target == GuidingTarget::variance &&
        (job.guiding.bootstrap > 0.0f || job.guiding.type == GuidingType::qtable))
        throw InputError(Location{"guiding.target", 0, 0},
                         "records of second moments cannot be made of the radiance that regions have learned",
                         "set guiding.target = \"radiance\", or guiding.bootstrap = 0 and another guide than qtable");
    if (job.guiding.splitting > 1 && job.guiding.roulette == GuidingRoulette::constant)
        throw InputError(Location{"guiding.splitting", 0, 0},
                         "where roulette is constant nobody knows what a path is expected to carry, so none is split",
                         "set guiding.roulette = \"adjoint\", or guiding.splitting to 0 or 1");
}

}  // namespace treefarm
