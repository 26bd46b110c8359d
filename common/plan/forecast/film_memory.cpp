// SPDX-License-Identifier: Apache-2.0
#include "common/plan/forecast/film_memory.h"

#include <algorithm>
#include <cmath>

#include "common/base/text/parse_text.h"
#include "common/config/aov_list.h"
#include "common/film/aov.h"
#include "common/film/fold_passes.h"
#include "common/film/pixel_codec.h"
#include "common/film/pixel_estimate.h"
#include "common/plan/schedule/schedule.h"

namespace treefarm {
namespace {

/// Numbers of a pixel in a message (docs/design/protocol.md, "payloads").
constexpr std::uint64_t kSentBytes = 12 * sizeof(double);
/// Mean and variance of a pixel and means of its halves.
constexpr std::uint64_t kImageBytes = 4 * sizeof(Rgb64);
/// The twelve channels of a pixel in an image that is being written, and in its file.
constexpr std::uint64_t kFileBytes = 2 * 12 * sizeof(float);

std::string amount_text(std::uint64_t count, const char* what) {
    return std::to_string(count) + " " + what;
}

/// Number of images of finished passes that the coordinator keeps.
std::uint64_t kept_passes(const Resolved& job) {
    if (job.budget.strict) return 1;  // each replaces the one before
    if (has_open_budget(job)) return kMostPassImages;
    return std::min(plan_passes(job).size(), kMostPassImages);
}

/// Number of films: the kept ones, and one that replaces another or is merged with it.
std::uint64_t films(const Resolved& job) {
    const bool replaces = job.budget.strict || has_open_budget(job) || plan_passes(job).size() > kMostPassImages;
    return kept_passes(job) + (replaces ? 1 : 0);
}

std::string passes_text(const Resolved& job) {
    const std::string kept = amount_text(kept_passes(job), "passes");
    if (job.budget.strict) return "the last pass";
    if (has_open_budget(job)) return "at most " + kept;
    const std::size_t passes = plan_passes(job).size();
    return passes > kMostPassImages ? amount_text(passes, "passes merged into ") + kept : kept;
}

/// Text about the loss by a kill: seconds between checkpoints, which take at most a tenth of the time.
std::string lost_by_kill(const Resolved& job, std::uint64_t pixels) {
    constexpr double kBytesPerSecond = 1e8;
    const auto bytes = static_cast<double>(kEstimateBytes * pixels * (kept_passes(job) + 1));
    return number_text(std::ceil(std::max(double(job.farm.checkpoint_seconds), 10 * bytes / kBytesPerSecond)));
}

/// Results in transit: pixels as a worker gathers them, or as the coordinator has decoded them, and their message.
MemoryItem results_item(std::uint64_t pixels, const AovLayout& aovs) {
    const std::uint64_t numbers = sizeof(double) * aovs.size();
    const std::uint64_t gathered = sizeof(PixelEstimate) * (aovs.direct() ? 2 : 1) + numbers;
    const std::uint64_t sent = kSentBytes * (aovs.direct() ? 2 : 1) + numbers;
    // Half of the image: each of several workers has a part of it.
    const std::uint64_t together = std::min(pixels / 2, kBundleBytes / gathered);
    return {"results", together * (gathered + sent),
            amount_text(together, "pixels in transit, ") + amount_text(gathered, "bytes each, and their message")};
}

MemoryItem aovs_item(const Resolved& job, std::uint64_t pixels, const AovLayout& aovs) {
    std::size_t channels = 0;
    for (const AovRequest& request : aov_requests(job))
        channels += request.channels().size();
    // AOVs of the current pass and of all; film and sums of direct light; channels of the image, of the previous one
    // while it is written, and its file.
    const std::uint64_t bytes = 2 * sizeof(double) * aovs.size() +
                                (aovs.direct() ? sizeof(PixelEstimate) + sizeof(Rgb64) : 0) +
                                4 * sizeof(float) * channels;
    return {"aovs", pixels * bytes,
            amount_text(channels, "channels: in image.exr ") +
                amount_text(sizeof(float) * channels, "bytes a pixel more, from workers ") +
                amount_text(sizeof(double) * aovs.size() + (aovs.direct() ? kSentBytes : 0), "per unit's pixel more")};
}

}  // namespace

void add_film_memory(const Scene& scene, const Resolved& job, MemoryPlan& plan) {
    const std::uint64_t pixels = scene.film.pixel_count();
    const AovLayout aovs(aov_requests(job));
    // The image before is still there, unless there is none; variances are sorted for their trimmed mean.
    const std::uint64_t images = films(job) > 1 ? 2 : 1;
    plan.coordinator.push_back(
        {"film", pixels * (films(job) * sizeof(PixelEstimate) + images * kImageBytes + kFileBytes + sizeof(double)),
         amount_text(pixels, "pixels, ") + passes_text(job)});
    const std::uint64_t sums = sizeof(double) * aovs.size() + (aovs.direct() ? sizeof(Rgb64) : 0);
    if (job.farm.checkpoint_seconds > 0)
        plan.coordinator.push_back({"checkpoint", pixels * (kept_passes(job) * kEstimateBytes + 2 * sums),
                                    "copies of " + passes_text(job) + (sums > 0 ? " and of two sums of AOVs" : "") +
                                        ", to be written; a kill loses at most some " + lost_by_kill(job, pixels) +
                                        " s (100 MB/s disk)"});
    if (!job.output.aovs.empty()) plan.coordinator.push_back(aovs_item(job, pixels, aovs));
    const MemoryItem results = results_item(pixels, aovs);
    plan.coordinator.push_back(results);
    plan.worker.push_back(results);
}

}  // namespace treefarm
