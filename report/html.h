// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/image/image.h"

namespace treefarm {

/// Text escaped for HTML, also in attributes.
std::string html_text(const std::string& text);

/// HTML table: the first row is its header, cells are HTML.
std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// Base64 text (RFC 4648), with padding.
std::string base64(std::vector<std::uint8_t> bytes);

/// Image in the viewer's format: base64 of red, green, blue and a common exponent, a byte each; negative and non-finite
/// values become black. Width and height are those of `image`.
std::string base64_rgbe(const RgbImage& image);

/// Image reduced to at most `longest` pixels a side, by averaging squares of pixels.
RgbImage reduced(const RgbImage& image, int longest);

}  // namespace treefarm
