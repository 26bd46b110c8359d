// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/image.h"
#include "tests/support/local_render.h"

namespace treefarm::test {

/// An image with its variance, as z-tests take them.
struct Rendered {
    RgbImage mean, variance;
};

inline Rendered rendered(const LocalRender& run, const Film& film) {
    Rendered images;
    images.mean = images.variance = RgbImage(film.width, film.height);
    for (std::size_t p = 0; p < images.mean.pixels.size(); ++p) {
        images.mean.pixels[p] = Rgb(run.image.mean[p]);
        images.variance.pixels[p] = Rgb(run.image.variance[p]);
    }
    return images;
}

}  // namespace treefarm::test
