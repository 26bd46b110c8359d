// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/run/render_run.h"

namespace treefarm {

/// Reads the model that guiding.initial_model of the request's job names, and completes the job by its hash and by the
/// samples that taught it. A render that gave guiding up leaves none: a warning, and the job begins with nothing.
/// Throws InputError for what is no run directory, another guide's model, or another model than the job's hash says.
void read_initial_model(RenderRequest& request);

}  // namespace treefarm
