// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <string>

#include "common/base/float_traps.h"
#include "common/config/job.h"
#include "common/film/combine.h"
#include "tests/support/local_render.h"

namespace treefarm::test {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Records a figure for docs/generated/hard-cases.md, attributed to the running test (tests/stability/write_page.py).
inline void figure(const std::string& what, double value) {
    std::ostringstream text;
    text.precision(3);
    text << what << " " << value;
    ::testing::Test::RecordProperty("figure", text.str());
}

/// Largest of many values, and its origin.
struct Worst {
    double value = 0;
    std::string where;

    template <class... Parts>
    void see(double seen, const Parts&... parts) {
        if (!(seen > value)) return;
        value = seen;
        std::ostringstream text;
        ((text << parts << ' '), ...);
        where = text.str();
    }
};

/// A job without guiding and without roulette.
inline Job plain_job(std::uint32_t spp, int max_depth, NextEvent next_event = NextEvent::never) {
    Job job;
    job.guiding.type = GuidingType::none;
    job.integrator.max_depth = max_depth;
    job.integrator.rr_depth = 1'000'000;
    job.integrator.next_event = next_event;
    job.budget.spp = spp;
    return job;
}

/// A plain_job() guided in a few passes, the last ones by a learned tree, combined without bias.
inline Job guided_job(std::uint32_t spp, int max_depth, NextEvent next_event = NextEvent::never) {
    Job job = plain_job(spp, max_depth, next_event);
    job.guiding.type = GuidingType::ppg;
    job.guiding.combination = Combination::fixed;
    job.guiding.spatial_threshold = 500;
    return job;
}

/// Mean of an image over pixels and channels, with its standard error.
struct ImageMean {
    double value = 0, error = 0;
};

inline ImageMean mean_of(const CombinedImage& image) {
    ImageMean mean;
    for (std::size_t i = 0; i < image.mean.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            mean.value += image.mean[i][c];
            mean.error += image.variance[i][c];
        }
    const auto count = static_cast<double>(3 * image.mean.size());
    return {mean.value / count, std::sqrt(mean.error * 3) / count};  // channels of a pixel are correlated
}

inline std::uint64_t invalid_samples(const LocalRender& run) {
    std::uint64_t sum = 0;
    for (const TraceStats& stats : run.stats)
        sum += stats.invalid_samples;
    return sum;
}

}  // namespace treefarm::test
