// SPDX-License-Identifier: Apache-2.0
#include "common/config/check_job.h"

#include <algorithm>
#include <set>

#include "common/base/error.h"
#include "common/config/aov_list.h"
#include "common/config/estimators.h"
#include "common/config/techniques.h"

namespace treefarm {

namespace {

/// Checks the combination of integrator.techniques with other keys.
void check_techniques(const Job& job) {
    if (job.integrator.mis == MisHeuristic::equal)
        throw InputError(Location{"integrator.mis", 0, 0},
                         "among many techniques equal weights would leave all the noise of the worst of them",
                         R"(set integrator.mis = "balance" or "power")");
    std::string why;
    const std::vector<Technique> techniques = parse_techniques(job.bidirectional.techniques, why);
    const auto is_light_image = [](const Technique& technique) { return technique.camera == 1; };
    if (!job.bidirectional.light_image && std::any_of(techniques.begin(), techniques.end(), is_light_image))
        throw InputError(Location{"bidirectional.techniques", 0, 0},
                         "paths from lamps are not connected to the lens, so one of the techniques stays black",
                         "set bidirectional.light_image = true, or name no technique with one vertex from the camera");
    if (job.bidirectional.weighted) return;
    std::set<int> lengths;
    for (const Technique& technique : techniques)
        lengths.insert(technique.light + technique.camera);
    if (techniques.empty() || lengths.size() < techniques.size())
        throw InputError(Location{"bidirectional.weighted", 0, 0},
                         "light would count once for every technique that finds it",
                         "set bidirectional.weighted = true, or name one technique of a length in "
                         "bidirectional.techniques, for instance \"1,2\"");
}

/// Checks that the job uses no feature that its estimator lacks.
void check_estimator(const Job& job, const Estimator& estimator) {
    const std::string name = "the estimator \"" + job.integrator.type + "\"";
    const std::string usual = std::string("integrator.type = \"") + estimators()[0].type + "\"";
    if (estimator.by_numbers && job.integrator.emitter_samples + job.integrator.bsdf_samples == 0)
        throw InputError(Location{"integrator.emitter_samples", 0, 0},
                         "neither emitters nor BSDFs are sampled: there is no light",
                         "set integrator.emitter_samples or integrator.bsdf_samples to 1 or more");
    if (!estimator.guides && job.guiding.type != GuidingType::none && job.guiding.type != GuidingType::automatic)
        throw InputError(Location{"guiding.type", 0, 0}, "nothing guides " + name,
                         "set guiding.type = \"none\", or " + usual);
    if (!estimator.has_camera_paths() && !job.output.aovs.empty())
        throw InputError(Location{"output.aovs", 0, 0},
                         name + " traces no ray from the camera, so it knows nothing of what is seen there",
                         "set output.aovs = \"\", or " + usual);
    for (const AovRequest& request : aov_requests(job)) {
        if (request.aov != Aov::direct && request.aov != Aov::indirect) continue;
        if (!estimator.sees_light)
            throw InputError(Location{"output.aovs", 0, 0}, name + " sees no light, direct or indirect",
                             "leave \"" + aov_text(request) + "\" out of output.aovs");
        if (estimator.splats())
            throw InputError(Location{"output.aovs", 0, 0},
                             name + " does not tell direct light from indirect: a path brings some to any pixel",
                             "leave \"" + aov_text(request) + "\" out of output.aovs, or set " + usual);
    }
    if (estimator.from == PathsFrom::both) check_techniques(job);
}

}  // namespace

void check_job(const Job& job) {
    const int max_depth = job.integrator.max_depth, rr_depth = job.integrator.rr_depth;
    if (max_depth < 0 && rr_depth > kLatestRoulette)
        throw InputError(
            Location{"integrator.rr_depth", 0, 0},
            "paths without a depth limit play roulette from depth " + std::to_string(rr_depth) +
                " only: in a closed scene they would not end",
            "set integrator.max_depth, or integrator.rr_depth to at most " + std::to_string(kLatestRoulette));
    check_estimator(job, estimator_of(job.integrator.type));
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
