// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "tests/support/hard_case.h"

namespace treefarm::test {

/// Estimators whose paths start at lamps, and all estimators that are compared.
inline constexpr const char* kFromLamps[] = {"light", "bidirectional"};
inline constexpr const char* kFromAnyEnd[] = {"path", "light", "bidirectional"};

/// Render of a plain_job() with next event by an estimator; light subpaths are kept on.
inline LocalRender render_by(const std::string& type, const Scene& scene, std::uint32_t spp, int max_depth,
                             const std::function<void(Job&)>& change = {}) {
    Job job = plain_job(spp, max_depth, NextEvent::always);
    job.integrator.type = type;
    job.bidirectional.light_subpaths = Rule::always;
    job.sampler.seed = static_cast<std::uint64_t>(type[0]);
    if (change) change(job);
    return render_locally(scene, job);
}

/// Change of a job that hides lamps seen directly: they are most of the noise of small images.
inline void hide_emitters(Job& job) {
    job.integrator.hide_emitters = true;
}

/// Compares means of renders from the lamps with path tracing's; returns the largest difference, in standard errors.
inline double expect_mean_of_paths(const Scene& scene, int max_depth, std::uint32_t spp, const std::string& what,
                                   const std::function<void(Job&)>& change = {}) {
    const ImageMean path = mean_of(render_by("path", scene, 2 * spp, max_depth, change).image);
    double worst = 0;
    for (const char* const type : kFromLamps) {
        const LocalRender run = render_by(type, scene, spp, max_depth, change);
        EXPECT_EQ(invalid_samples(run), 0u) << type << ", " << what;
        EXPECT_EQ(run.splat_caps.capped, 0u) << type << ", " << what;
        EXPECT_EQ(run.splat_caps.rejected, 0u) << type << ", " << what;
        const ImageMean mean = mean_of(run.image);
        const double error = std::hypot(mean.error, path.error);
        EXPECT_NEAR(mean.value, path.value, 4.5 * error) << type << ", " << what;
        EXPECT_LT(error, 0.05 * path.value) << type << ", " << what << ": too noisy to tell";
        worst = std::max(worst, std::abs(mean.value - path.value) / error);
    }
    return worst;
}

}  // namespace treefarm::test
