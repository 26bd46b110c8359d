// SPDX-License-Identifier: Apache-2.0
#include "cli/probe_here.h"

#include <cmath>

#include "cli/on_farm.h"
#include "common/base/host.h"
#include "common/base/interrupt.h"

namespace treefarm {

namespace {

/// Number of pixels above which a film is probed on a smaller one.
constexpr double kProbePixels = 1 << 17;

}  // namespace

std::pair<RenderRequest, double> smaller_film(const RenderRequest& whole) {
    const Film& film = whole.content.scene.film;
    const double pixels = static_cast<double>(film.pixel_count()), scale = std::sqrt(kProbePixels / pixels);
    RenderRequest request = whole;
    if (scale >= 1) return {std::move(request), 1.0};
    Film& small = request.content.scene.film;
    const auto scaled = [scale](int side) { return static_cast<int>(std::ceil(scale * side)); };
    small.width = scaled(film.width);
    small.height = scaled(film.height);
    if (film.crop.is_window())
        small.crop = {scaled(film.crop.x), scaled(film.crop.y), scaled(film.crop.x) + scaled(film.crop.whole_width),
                      scaled(film.crop.y) + scaled(film.crop.whole_height)};
    request.content.plan = plan_effects(request.content.scene, request.content.job);
    const double ratio = pixels / static_cast<double>(small.pixel_count());
    return {std::move(request), ratio};
}

Probe probe_here(RenderRequest& request, double seconds, unsigned threads) {
    const LogOutput log_output = errors_only();
    ignore_broken_pipes();
    InterruptWatch watch;
    request.workers.local = local_worker(threads, log_output);
    request.workers.stop = [&] { return watch.interrupted(); };
    Probe probe = run_probe(request, seconds, console_messages("treefarm", log_output.console, log_output.verbosity));
    probe.threads = threads > 0 ? threads : affinity_threads();
    return probe;
}

}  // namespace treefarm
