// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/done_work.h"

namespace treefarm {

/// Visits the finished parts of a partial pass, pixel by pixel: whole(pixel) if all chunks are finished, otherwise
/// part(pixel, chunk) for each finished one. All layers store and restore in this order.
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
