// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/regions/first_model.h"
#include "common/guiding/statistics/cell_accumulator.h"

namespace treefarm {

/// Shape of the sums per cell of a pass over a model of guide `G`. `with_mixture`: the pass records for mixtures, too.
template <class G>
SumsShape cell_shape(const typename G::Model& model, bool with_mixture) {
    const ModelFigures size = G::figures(model);
    return {static_cast<std::uint32_t>(size.regions),
            static_cast<std::uint32_t>(size.cells),
            with_mixture,
            static_cast<std::uint32_t>(size.views),
            model.learns_lights(),
            counts_visits<typename G::Sampler>(),
            model.decides_next_event()};
}

}  // namespace treefarm
