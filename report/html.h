// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/image/image.h"

namespace treefarm {

/// Text as it may stand in HTML, in attributes too.
std::string html_text(const std::string& text);

/// A table: the first row is its head, cells are HTML.
std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// RFC 4648, with padding.
std::string base64(std::vector<std::uint8_t> bytes);

/// An image as the viewer reads it: base64 of red, green, blue and a common exponent, a byte each; values below zero
/// and those that are no numbers become black. Width and height are those of `image`.
std::string base64_rgbe(const RgbImage& image);

/// An image of at most `longest` pixels a side, by averaging squares of pixels.
RgbImage reduced(const RgbImage& image, int longest);

}  // namespace treefarm
