// SPDX-License-Identifier: Apache-2.0
#include "common/film/work_unit.h"

#include <algorithm>

namespace treefarm {
namespace {

std::vector<WorkUnit> quarter(const WorkUnit& tile) {
    if (tile.x1 - tile.x0 < 2 || tile.y1 - tile.y0 < 2) return {tile};
    const auto xm = static_cast<std::uint16_t>((tile.x0 + tile.x1) / 2);
    const auto ym = static_cast<std::uint16_t>((tile.y0 + tile.y1) / 2);
    return {{tile.pass, tile.x0, tile.y0, xm, ym, tile.chunk},
            {tile.pass, xm, tile.y0, tile.x1, ym, tile.chunk},
            {tile.pass, tile.x0, ym, xm, tile.y1, tile.chunk},
            {tile.pass, xm, ym, tile.x1, tile.y1, tile.chunk}};
}

std::vector<WorkUnit> split_range(const WorkUnit& range) {
    if (range.count < 2) return {range};
    WorkUnit first = range, second = range;
    first.count = range.count / 2;
    second.first += first.count;
    second.count -= first.count;
    return {first, second};
}

}  // namespace

std::uint64_t weight(const WorkUnit& unit) {
    return unit.kind == UnitKind::tile ? unit.pixel_count() : unit.count;
}

std::vector<WorkUnit> halve(const WorkUnit& unit) {
    return unit.kind == UnitKind::tile ? quarter(unit) : split_range(unit);
}

std::vector<WorkUnit> cut_tiles(std::uint32_t pass, std::uint32_t chunks, int width, int height, int tile_size) {
    std::vector<WorkUnit> units;
    for (int y = 0; y < height; y += tile_size)
        for (int x = 0; x < width; x += tile_size)
            for (std::uint32_t chunk = 0; chunk < chunks; ++chunk)
                units.push_back({pass, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                                 static_cast<std::uint16_t>(std::min(x + tile_size, width)),
                                 static_cast<std::uint16_t>(std::min(y + tile_size, height)), chunk});
    return units;
}

std::vector<WorkUnit> cut_range(std::uint32_t pass, UnitKind kind, std::uint64_t count, std::uint32_t most) {
    std::vector<WorkUnit> units;
    for (std::uint64_t first = 0; first < count; first += most) {
        WorkUnit unit{.pass = pass, .kind = kind, .first = first};
        unit.count = static_cast<std::uint32_t>(std::min<std::uint64_t>(most, count - first));
        units.push_back(unit);
    }
    return units;
}

}  // namespace treefarm
