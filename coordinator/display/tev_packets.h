// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/bytes.h"
#include "common/image/image.h"

namespace treefarm {

// Packets of tev's protocol over TCP (https://github.com/Tom94/tev, README, "Over the Network"; fields as its Ipc.h
// reads them): the length of the whole packet, a byte for the operation, its fields. Numbers are little-endian, texts
// end with a zero byte.

/// CreateImage: a black image with the channels R, G and B. Replaces an image of this name.
Bytes tev_create_image(const std::string& name, int width, int height);

/// UpdateImage, version 3: the rows from `first` to below `end`, with each pixel's R, G and B interleaved.
Bytes tev_update_rows(const std::string& name, const RgbImage& image, int first, int end);

/// Number of rows in one packet of about a quarter of a megabyte.
int tev_rows_per_packet(int width);

}  // namespace treefarm
