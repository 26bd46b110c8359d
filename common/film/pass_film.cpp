// SPDX-License-Identifier: Apache-2.0
#include "common/film/pass_film.h"

#include <array>
#include <bit>
#include <cstring>

#include "common/base/error.h"

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

namespace {

constexpr std::size_t kEstimateBytes = 2 * (sizeof(std::uint32_t) + 6 * sizeof(double));

/// All its bytes at once: there are millions.
void put(ByteWriter& writer, const PixelEstimate& pixel) {
    static_assert(sizeof(Rgb64) == 3 * sizeof(double));
    std::array<std::uint8_t, kEstimateBytes> bytes;
    std::uint8_t* next = bytes.data();
    const auto add = [&](const auto& value) {
        std::memcpy(next, &value, sizeof value);
        next += sizeof value;
    };
    for (const Moments& half : pixel.half) {
        add(half.n);
        add(half.mean);
        add(half.m2);
    }
    writer.put_bytes(bytes);
}

PixelEstimate get(ByteReader& reader) {
    PixelEstimate pixel;
    for (Moments& half : pixel.half) {
        half.n = reader.get<std::uint32_t>();
        for (Rgb64* sum : {&half.mean, &half.m2})
            for (double* value : {&sum->x, &sum->y, &sum->z})
                *value = reader.get<double>();
    }
    return pixel;
}

}  // namespace

Bytes PassFilm::encode(const DoneWork& done) const {
    ByteWriter writer;
    writer.reserve(done.estimate_count() * kEstimateBytes);
    for (std::uint32_t pixel = 0; pixel < pixels_.size(); ++pixel) {
        const auto pending = pending_.find(pixel);
        if (pending == pending_.end()) {
            if (done.whole(pixel)) put(writer, pixels_[pixel]);
            continue;
        }
        for (std::uint32_t chunk = 0; chunk < chunks_; ++chunk)
            if (done.has(pixel, chunk)) put(writer, pending->second.chunks[chunk]);
    }
    return writer.take();
}

void PassFilm::restore(const DoneWork& done, std::span<const std::uint8_t> bytes) {
    if (done.pixel_count() != pixels_.size() || done.chunks() != chunks_ ||
        bytes.size() != done.estimate_count() * kEstimateBytes)
        throw FormatError("the film of a pass in hand has another size");
    ByteReader reader(bytes);
    for (std::uint32_t pixel = 0; pixel < pixels_.size(); ++pixel) {
        if (done.whole(pixel)) {
            pixels_[pixel] = get(reader);
            missing_ -= chunks_;
            continue;
        }
        for (std::uint32_t chunk = 0; chunk < chunks_; ++chunk) {
            if (!done.has(pixel, chunk)) continue;
            Pending& pending = pending_[pixel];
            pending.chunks.resize(chunks_);
            pending.chunks[chunk] = get(reader);
            ++pending.arrived;
            --missing_;
        }
    }
}

}  // namespace treefarm
