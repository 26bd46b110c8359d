// SPDX-License-Identifier: Apache-2.0
#pragma once

// The only way to Embree's headers. What versions 3 and 4 call differently has one name here:
//
// class EmbreeRays       asks about rays, all of them as incoherent ones: each finds its own way through the hierarchy,
//                        so that its answer does not depend on its company
// set_instance()         names the instance in a hit that a callback reports
//
// Everything else is called and does the same in both.
#if TREEFARM_EMBREE == 3
#include "worker/geometry/embree3_api.h"
#else
#include "worker/geometry/embree4_api.h"
#endif
