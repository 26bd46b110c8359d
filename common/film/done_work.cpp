// SPDX-License-Identifier: Apache-2.0
#include "common/film/done_work.h"

#include <algorithm>
#include <bit>
#include <iterator>

namespace treefarm {

DoneWork::DoneWork(int width, int height, std::uint32_t chunks)
    : width_(static_cast<std::uint32_t>(width)),
      chunks_(chunks),
      pixels_(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height)),
      bits_((pixels_ * chunks + 63) / 64) {}

void DoneWork::add(const WorkUnit& unit) {
    weight_ += treefarm::weight(unit);
    if (unit.kind == UnitKind::tile) {
        for (std::size_t y = unit.y0; y < unit.y1; ++y)
            for (std::size_t x = unit.x0; x < unit.x1; ++x) {
                const std::size_t bit = unit.chunk * pixels_ + y * width_ + x;
                bits_[bit / 64] |= std::uint64_t{1} << bit % 64;
            }
        return;
    }
    auto& ranges = ranges_[static_cast<std::size_t>(unit.kind)];
    auto at = ranges.insert({unit.first, unit.first + unit.count}).first;
    if (const auto next = std::next(at); next != ranges.end() && next->first == at->second) {
        at->second = next->second;
        ranges.erase(next);
    }
    if (at != ranges.begin() && std::prev(at)->second == at->first) {
        std::prev(at)->second = at->second;
        ranges.erase(at);
    }
}

bool DoneWork::whole(std::size_t pixel) const {
    for (std::uint32_t chunk = 0; chunk < chunks_; ++chunk)
        if (!has(pixel, chunk)) return false;
    return true;
}

std::vector<WorkUnit> DoneWork::left_of(const WorkUnit& unit) const {
    return unit.kind == UnitKind::tile ? left_of_tile(unit) : left_of_range(unit);
}

/// Runs of pixels, row by row; a run below a rectangle of the same columns extends it.
std::vector<WorkUnit> DoneWork::left_of_tile(const WorkUnit& tile) const {
    std::vector<WorkUnit> pieces;
    for (std::uint16_t y = tile.y0; y < tile.y1; ++y)
        for (std::uint16_t x = tile.x0; x < tile.x1;) {
            const auto done = [&](std::uint16_t column) { return has(std::size_t{y} * width_ + column, tile.chunk); };
            std::uint16_t end = x;
            while (end < tile.x1 && !done(end))
                ++end;
            if (end == x) {
                ++x;
                continue;
            }
            const auto above = std::find_if(pieces.begin(), pieces.end(), [&](const WorkUnit& piece) {
                return piece.y1 == y && piece.x0 == x && piece.x1 == end;
            });
            if (above != pieces.end())
                ++above->y1;
            else
                pieces.push_back({tile.pass, x, y, end, static_cast<std::uint16_t>(y + 1), tile.chunk});
            x = end;
        }
    return pieces;
}

std::vector<WorkUnit> DoneWork::left_of_range(const WorkUnit& range) const {
    std::vector<WorkUnit> pieces;
    const std::uint64_t end = range.first + range.count;
    std::uint64_t at = range.first;
    const auto add_until = [&](std::uint64_t stop) {
        if (at >= stop) return;
        WorkUnit piece = range;
        piece.first = at;
        piece.count = static_cast<std::uint32_t>(stop - at);
        pieces.push_back(piece);
    };
    for (const auto& [first, last] : ranges_[static_cast<std::size_t>(range.kind)]) {
        if (last <= at) continue;
        if (first >= end) break;
        add_until(first);
        at = last;
    }
    add_until(end);
    return pieces;
}

std::size_t DoneWork::estimate_count() const {
    std::size_t count = 0;
    for (const std::uint64_t word : bits_)
        count += static_cast<std::size_t>(std::popcount(word));
    if (chunks_ > 1)
        for (std::size_t pixel = 0; pixel < pixels_; ++pixel)
            if (whole(pixel)) count -= chunks_ - 1;
    return count;
}

bool DoneWork::fits(std::size_t pixels, std::uint32_t chunks, const std::array<std::uint64_t, kUnitKinds>& ends) const {
    if (pixels_ != pixels || chunks_ != chunks || width_ == 0 || pixels_ % width_ != 0) return false;
    if (bits_.size() != (pixels_ * chunks_ + 63) / 64) return false;
    if (const std::size_t used = pixels_ * chunks_ % 64; used > 0 && bits_.back() >> used != 0) return false;
    std::uint64_t weight = 0;
    for (const std::uint64_t word : bits_)
        weight += static_cast<std::uint64_t>(std::popcount(word));
    for (std::size_t kind = 0; kind < kUnitKinds; ++kind) {
        std::uint64_t before = 0;
        for (const auto& [first, last] : ranges_[kind]) {
            const bool apart = first > before || (first == 0 && before == 0);
            if (!apart || last <= first || last > ends[kind]) return false;
            weight += last - first;
            before = last;
        }
    }
    return weight == weight_;
}

}  // namespace treefarm
