// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/done_work.h"

namespace treefarm {

/// What a film holds of a pass in hand, pixel by pixel: calls whole(pixel) where all chunks are done, otherwise
/// part(pixel, chunk) for each that is. Every layer stores and restores in this order.
template <class Whole, class Part>
void for_each_done(const DoneWork& done, const Whole& whole, const Part& part) {
    for (std::uint32_t pixel = 0; pixel < done.pixel_count(); ++pixel) {
        if (done.whole(pixel)) {
            whole(pixel);
            continue;
        }
        for (std::uint32_t chunk = 0; chunk < done.chunks(); ++chunk)
            if (done.has(pixel, chunk)) part(pixel, chunk);
    }
}

}  // namespace treefarm
