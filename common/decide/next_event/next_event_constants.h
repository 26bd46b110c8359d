// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/policy.h"

namespace treefarm::policy {

/// Share of vertices at which next event samples emitters ("auto").
inline constexpr Constant kNextEvent[] = {
    {"next_event.counted_every", 8,
     "direct light is summed along one of so many samples of a pixel; along all of them it would take 17 % of the time",
     kDecisions},
    {"next_event.least_vertices", 512.0, "nothing is decided from fewer, of all regions together", kDecisions},
    {"next_event.lent_vertices", 256.0,
     "what is known of the cube about a region counts as so many vertices of its own", kDecisions,
     "1.00, 1.00 (2026-11-28)"},
    {"next_event.standard_errors", 2.0, "by how many standard errors fewer light samples must win", kDecisions,
     "0.99, 1.02 (2026-11-28)"},
    {"next_event.least_gain", 0.03, "and by this share of the region's own noise and cost", kDecisions,
     "1.00, 1.00 (2026-11-28)"},
    {"next_event.learned", 0.1,
     "part of a guided region's noise and cost that trees are expected to take away with each step to fewer light "
     "samples, which they learn",
     kJoint, "1.02, 0.99 (2026-11-28)"},
    {"next_event.sample_cost", 0.25, "cost of a light sample without its ray, in rays", kRare,
     "1.01, 0.99 (2026-11-28)"},
    {"next_event.shadow_ray_cost", 1.0, "cost of a shadow ray and its weights, in rays", kRare},
};

}  // namespace treefarm::policy
