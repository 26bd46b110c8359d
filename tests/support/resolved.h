// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/plan/resolve/resolve.h"
#include "common/plan/schedule/kernel.h"
#include "worker/integrators/path/tile_renderer.h"
#include "worker/tools/describe_sample.h"

namespace treefarm::test {

/// Job resolved for a scene of 512 x 512 pixels without view-dependent surfaces and without choices.
inline Resolved resolved(const Job& job) {
    return resolve(job, SceneFacts{});
}

/// Job resolved for a scene of which only the film is known.
inline Resolved resolved(const Job& job, const TraceScene& scene) {
    SceneFacts facts;
    facts.film_pixels = scene.film().pixel_count();
    facts.plainly_diffuse = scene.plainly_diffuse();
    return resolve(job, facts);
}

/// Pass with the kernel that a coordinator would choose, for the tree of `guide`.
inline PassPlan with_kernel(const Resolved& job, PassPlan pass, const AnySampler& guide) {
    pass.guided = pass.guided && job.guides;
    pass.kernel = kernel_of(job, pass, facts_of(guide));
    return pass;
}

inline void render_unit(const TraceScene& scene, const Job& job, const PassPlan& pass, const AnySampler& guide,
                        const WorkUnit& unit, std::vector<PixelEstimate>& pixels, RecordLog& log, UnitStats& stats) {
    const Resolved as_used = resolved(job, scene);
    AnyLog logs;
    treefarm::render_unit(scene, as_used, with_kernel(as_used, pass, guide), guide, unit, pixels, logs, stats);
    with_guide(guide.kind(), [&]<class G>() { log = std::move(logs.of<G>()); });
}

inline std::string describe_sample(const TraceScene& scene, const Job& job, const PassPlan& pass,
                                   const AnySampler& guide, int x, int y, std::uint32_t sample) {
    const Resolved as_used = resolved(job, scene);
    return treefarm::describe_sample(scene, as_used, with_kernel(as_used, pass, guide), guide, x, y, sample);
}

}  // namespace treefarm::test
