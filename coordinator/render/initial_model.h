// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/render/render_request.h"

namespace treefarm {

/// Reads the model that guiding.initial_model of the request's job names, and adds its hash and number of samples to
/// the job. A render that gave guiding up has none: the job then begins without a model, with a warning. Throws
/// InputError if it is no run directory, or the model is another guide's, or has another hash than the job says.
void read_initial_model(RenderRequest& request);

}  // namespace treefarm
