// SPDX-License-Identifier: Apache-2.0
#include "common/film/aov_film.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "common/base/error.h"
#include "common/film/each_done.h"
#include "common/film/radiance_limit.h"

namespace treefarm {

void reduce_aov_blocks(const AovLayout& layout, std::span<double> blocks) {
    const std::size_t row = layout.size(), count = blocks.size() / row;
    if (count < 2) return;
    const std::size_t left = std::bit_floor(count - 1) * row;
    reduce_aov_blocks(layout, blocks.first(left));
    reduce_aov_blocks(layout, blocks.subspan(left));
    for (std::size_t i = 0; i < layout.id_begin(); ++i)
        blocks[i] += blocks[left + i];
}

AovFilm::AovFilm(const AovLayout& layout, int width, int height, std::uint32_t chunks)
    : layout_(layout),
      width_(width),
      chunks_(chunks),
      values_(layout.size() * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
      direct_(layout.direct() ? width : 0, layout.direct() ? height : 0, chunks) {}

void AovFilm::check(const WorkUnit& unit, const AovPixels& pixels, std::uint32_t samples, bool is_signed) const {
    if (pixels.values.size() != std::size_t{layout_.size()} * unit.pixel_count() ||
        pixels.direct.size() != (layout_.direct() ? unit.pixel_count() : 0))
        throw FormatError("a work unit with AOVs that nobody asked for, or without those asked for");
    if (!std::all_of(pixels.values.begin(), pixels.values.end(), [&](double v) { return is_sum_of(samples, v); }))
        throw FormatError("an AOV that is not finite, or too large");
    for (const PixelEstimate& pixel : pixels.direct)
        for (const Moments& half : pixel.half)
            if (!are_moments_of_radiance(half, is_signed))
                throw FormatError("direct light that is negative, not finite or too large");
}

void AovFilm::add(const WorkUnit& unit, const AovPixels& pixels) {
    if (layout_.direct()) direct_.add(unit, pixels.direct);
    const std::size_t row = layout_.size();
    if (row == 0) return;
    const double* next = pixels.values.data();
    for (std::uint32_t y = unit.y0; y < unit.y1; ++y)
        for (std::uint32_t x = unit.x0; x < unit.x1; ++x, next += row) {
            const std::uint32_t pixel = y * static_cast<std::uint32_t>(width_) + x;
            double* const to = &values_[row * pixel];
            if (chunks_ == 1) {
                std::copy(next, next + row, to);
                continue;
            }
            Pending& pending = pending_[pixel];
            pending.chunks.resize(row * chunks_);
            std::copy(next, next + row, &pending.chunks[row * unit.chunk]);
            if (++pending.arrived < chunks_) continue;
            reduce_aov_blocks(layout_, pending.chunks);
            std::copy(pending.chunks.begin(), pending.chunks.begin() + static_cast<std::ptrdiff_t>(row), to);
            pending_.erase(pixel);
        }
}

Bytes AovFilm::encode(const DoneWork& done) const {
    const std::size_t row = layout_.size();
    ByteWriter writer;
    const auto put_row = [&](const double* values) {
        writer.put_bytes({reinterpret_cast<const std::uint8_t*>(values), row * sizeof(double)});
    };
    if (row > 0) {
        writer.reserve(done.estimate_count() * row * sizeof(double));
        for_each_done(
            done, [&](std::uint32_t pixel) { put_row(&values_[row * pixel]); },
            [&](std::uint32_t pixel, std::uint32_t chunk) { put_row(&pending_.at(pixel).chunks[row * chunk]); });
    }
    if (layout_.direct()) writer.put_bytes(direct_.encode(done));
    return writer.take();
}

void AovFilm::restore(const DoneWork& done, std::span<const std::uint8_t> bytes) {
    const std::size_t row = layout_.size();
    if (row > 0 && (done.pixel_count() * row != values_.size() || done.chunks() != chunks_))
        throw FormatError("the AOVs of a partial pass have another size");
    ByteReader reader(bytes);
    ByteReader rows(reader.get_bytes(row == 0 ? 0 : done.estimate_count() * row * sizeof(double)));
    if (layout_.direct()) direct_.restore(done, reader.get_rest());
    reader.expect_end();
    if (row == 0) return;
    const auto get_row = [&](double* values) {
        std::memcpy(values, rows.get_bytes(row * sizeof(double)).data(), row * sizeof(double));
    };
    for_each_done(
        done, [&](std::uint32_t pixel) { get_row(&values_[row * pixel]); },
        [&](std::uint32_t pixel, std::uint32_t chunk) {
            Pending& pending = pending_[pixel];
            pending.chunks.resize(row * chunks_);
            get_row(&pending.chunks[row * chunk]);
            ++pending.arrived;
        });
}

AovPixels AovFilm::take() {
    return {std::exchange(values_, {}), direct_.take_pixels()};
}

AovSums::AovSums(std::span<const AovRequest> requests, std::size_t pixel_count)
    : requests_(requests.begin(), requests.end()),
      layout_(requests),
      pixel_count_(pixel_count),
      values_(layout_.size() * pixel_count),
      direct_(layout_.direct() ? pixel_count : 0, Rgb64(0.0)) {}

void AovSums::add(const AovPixels& pass, std::uint32_t spp) {
    const std::size_t row = layout_.size();
    for (std::size_t i = 0; i < values_.size(); ++i)
        if (i % row < layout_.id_begin())
            values_[i] += pass.values[i];
        else if (spp_ == 0)
            values_[i] = pass.values[i];
    for (std::size_t p = 0; p < direct_.size(); ++p) {
        const Moments whole = pass.direct[p].whole();
        direct_[p] += whole.mean * static_cast<double>(whole.n);
    }
    spp_ += spp;
}

void AovSums::develop(Aov aov, std::uint32_t component, const CombinedImage& image, std::span<const PassResult> passes,
                      std::vector<float>& out) const {
    const std::size_t row = layout_.size();
    const auto samples = static_cast<double>(spp_);
    for (std::size_t p = 0; p < pixel_count_; ++p) {
        const auto gathered = [&](Aov of) { return values_[row * p + layout_.at(of) + component]; };
        double value = 0;
        switch (aov) {
            case Aov::albedo:
            case Aov::normal:
            case Aov::geometric_normal:
            case Aov::alpha:
                value = gathered(aov) / samples;
                break;
            case Aov::depth:
            case Aov::distance:
            case Aov::position:
            case Aov::uv: {
                const double hits = values_[row * p + layout_.at(Aov::alpha)];
                value = hits > 0 ? gathered(aov) / hits : 0.0;
                break;
            }
            case Aov::shape:
            case Aov::material:
                value = gathered(aov);
                break;
            case Aov::direct:
                value = direct_[p][static_cast<int>(component)] / samples;
                break;
            case Aov::indirect:
                value = image.mean[p][static_cast<int>(component)] - direct_[p][static_cast<int>(component)] / samples;
                break;
            case Aov::spp:
                for (const PassResult& pass : passes)
                    value += static_cast<double>(pass.pixels[p].half[0].n) + pass.pixels[p].half[1].n;
                break;
        }
        out[p] = static_cast<float>(value);
    }
}

std::vector<AovChannel> AovSums::channels(const CombinedImage& image, std::span<const PassResult> passes) const {
    std::vector<AovChannel> channels;
    for (const AovRequest& request : requests_) {
        std::uint32_t component = 0;
        for (const std::string& name : request.channels()) {
            channels.push_back({name, kind_of(request.aov).precise, std::vector<float>(pixel_count_)});
            develop(request.aov, component++, image, passes, channels.back().values);
        }
    }
    return channels;
}

}  // namespace treefarm
