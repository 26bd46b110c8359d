// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Where an image lies in a larger one that it is a window of: what a crop window cuts out of a film. The window's own
/// size is the image's.
struct CropWindow {
    int x = 0, y = 0;                       ///< of its upper left pixel
    int whole_width = 0, whole_height = 0;  ///< of the larger one, pixels; 0: the image is the whole

    bool is_window() const { return whole_width > 0; }
    bool operator==(const CropWindow&) const = default;
};

}  // namespace treefarm
