// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Position of an image in a larger one: the part that a crop window cuts out of a film. The window's own size is the
/// image's.
struct CropWindow {
    int x = 0, y = 0;                       ///< position of its upper left pixel
    int whole_width = 0, whole_height = 0;  ///< size of the larger image, pixels; 0: the image is the whole

    bool is_window() const { return whole_width > 0; }
    bool operator==(const CropWindow&) const = default;
};

}  // namespace treefarm
