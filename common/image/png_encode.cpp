// SPDX-License-Identifier: Apache-2.0
#include "common/image/png_encode.h"

#include <zlib.h>

#include <iterator>
#include <string_view>

namespace treefarm {

namespace {

using Bytes = std::vector<std::uint8_t>;

void append_word(Bytes& file, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        file.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(Bytes& file, std::string_view kind, std::span<const std::uint8_t> content) {
    append_word(file, static_cast<std::uint32_t>(content.size()));
    const std::size_t begin = file.size();
    file.insert(file.end(), kind.begin(), kind.end());
    file.insert(file.end(), content.begin(), content.end());
    append_word(file,
                static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), file.data() + begin, file.size() - begin)));
}

/// Rows, each as the difference from the one above: rendered images have few other regularities, and no filter is
/// cheaper.
Bytes filtered(std::size_t row_bytes, std::span<const std::uint8_t> bytes) {
    constexpr std::uint8_t kUp = 2;
    const std::size_t rows = bytes.size() / row_bytes;
    Bytes lines((row_bytes + 1) * rows);
    const Bytes black(row_bytes);
    const std::uint8_t* above = black.data();
    for (std::size_t y = 0; y < rows; ++y) {
        const std::uint8_t* row = bytes.data() + y * row_bytes;
        std::uint8_t* line = lines.data() + y * (row_bytes + 1);
        *line++ = kUp;
        for (std::size_t k = 0; k < row_bytes; ++k)
            line[k] = static_cast<std::uint8_t>(row[k] - above[k]);
        above = row;
    }
    return lines;
}

/// Rows compressed by runs and Huffman codes only: a search for repetitions in noise takes twice the time and finds
/// none.
Bytes deflated(Bytes& lines) {
    z_stream stream{};
    if (deflateInit2(&stream, 1, Z_DEFLATED, 15, 9, Z_RLE) != Z_OK) return {};
    Bytes packed(deflateBound(&stream, lines.size()));
    stream.next_in = lines.data();
    stream.avail_in = static_cast<uInt>(lines.size());
    stream.next_out = packed.data();
    stream.avail_out = static_cast<uInt>(packed.size());
    const bool done = deflate(&stream, Z_FINISH) == Z_STREAM_END;
    packed.resize(done ? stream.total_out : 0);
    deflateEnd(&stream);
    return packed;
}

}  // namespace

std::vector<std::uint8_t> encode_png(int width, int height, int channels, std::span<const std::uint8_t> bytes) {
    if (width < 1 || height < 1) return {};
    const std::size_t row = static_cast<std::size_t>(channels) * static_cast<std::size_t>(width);
    if (bytes.size() != row * static_cast<std::size_t>(height) || bytes.size() > 0x70000000) return {};
    Bytes lines = filtered(row, bytes);
    const Bytes packed = deflated(lines);
    if (packed.empty()) return {};
    Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    file.reserve(packed.size() + 64);
    Bytes header;
    append_word(header, static_cast<std::uint32_t>(width));
    append_word(header, static_cast<std::uint32_t>(height));
    // bits, RGB or RGBA, deflate, filters by row, not interlaced
    const std::uint8_t format[] = {8, static_cast<std::uint8_t>(channels == 4 ? 6 : 2), 0, 0, 0};
    header.insert(header.end(), std::begin(format), std::end(format));
    append_chunk(file, "IHDR", header);
    append_chunk(file, "IDAT", packed);
    append_chunk(file, "IEND", {});
    return file;
}

}  // namespace treefarm
