// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "coordinator/render/probe.h"

namespace treefarm {

/// Request on a smaller film if it is large, with the ratio of the numbers of pixels: noise per pixel hardly depends on
/// it, time does.
std::pair<RenderRequest, double> smaller_film(const RenderRequest& whole);

/// Probe of a request by so many threads of this process (0: its processors); Ctrl-C interrupts it. Throws RunError.
Probe probe_here(RenderRequest& request, double seconds, unsigned threads);

}  // namespace treefarm
