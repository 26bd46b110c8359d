// SPDX-License-Identifier: Apache-2.0
#include "common/film/pass_film.h"

#include <bit>

#include "common/base/error.h"
#include "common/film/each_done.h"
#include "common/film/pixel_codec.h"

namespace treefarm {

PixelEstimate reduce_blocks(std::span<const PixelEstimate> blocks) {
    if (blocks.empty()) return {};
    if (blocks.size() == 1) return blocks[0];
    const std::size_t left = std::bit_floor(blocks.size() - 1);
    return PixelEstimate::merge(reduce_blocks(blocks.first(left)), reduce_blocks(blocks.subspan(left)));
}

PassFilm::PassFilm(int width, int height, std::uint32_t chunks)
    : width_(width),
      height_(height),
      chunks_(chunks),
      missing_(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * chunks),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

void PassFilm::add(const WorkUnit& unit, std::span<const PixelEstimate> pixels) {
    if (unit.x0 >= unit.x1 || unit.y0 >= unit.y1 || unit.x1 > width_ || unit.y1 > height_ || unit.chunk >= chunks_ ||
        pixels.size() != unit.pixel_count() || missing_ < pixels.size())
        throw FormatError("a work unit does not fit the film");
    const PixelEstimate* next = pixels.data();
    for (std::uint32_t y = unit.y0; y < unit.y1; ++y)
        for (std::uint32_t x = unit.x0; x < unit.x1; ++x, ++next) {
            const std::uint32_t pixel = y * static_cast<std::uint32_t>(width_) + x;
            if (chunks_ == 1) {
                pixels_[pixel] = *next;
                continue;
            }
            Pending& pending = pending_[pixel];
            pending.chunks.resize(chunks_);
            pending.chunks[unit.chunk] = *next;
            if (++pending.arrived < chunks_) continue;
            pixels_[pixel] = reduce_blocks(pending.chunks);
            pending_.erase(pixel);
        }
    missing_ -= pixels.size();
}

Bytes PassFilm::encode(const DoneWork& done) const {
    ByteWriter writer;
    writer.reserve(done.estimate_count() * kEstimateBytes);
    for_each_done(
        done, [&](std::uint32_t pixel) { put_estimate(writer, pixels_[pixel]); },
        [&](std::uint32_t pixel, std::uint32_t chunk) { put_estimate(writer, pending_.at(pixel).chunks[chunk]); });
    return writer.take();
}

void PassFilm::restore(const DoneWork& done, std::span<const std::uint8_t> bytes) {
    if (done.pixel_count() != pixels_.size() || done.chunks() != chunks_ ||
        bytes.size() != done.estimate_count() * kEstimateBytes)
        throw FormatError("the film of a partial pass has another size");
    ByteReader reader(bytes);
    for_each_done(
        done,
        [&](std::uint32_t pixel) {
            pixels_[pixel] = get_estimate(reader);
            missing_ -= chunks_;
        },
        [&](std::uint32_t pixel, std::uint32_t chunk) {
            Pending& pending = pending_[pixel];
            pending.chunks.resize(chunks_);
            pending.chunks[chunk] = get_estimate(reader);
            ++pending.arrived;
            --missing_;
        });
}

}  // namespace treefarm
