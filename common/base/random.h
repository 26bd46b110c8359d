// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Random123/philox.h>

#include <array>
#include <cstdint>

namespace treefarm {

/// The use of a random number. Each has a stream of its own, so switching an effect on never shifts another effect's
/// numbers (docs/design/guiding.md, "random streams").
enum class Stream : std::uint32_t {
    camera,        ///< position on the pixel filter
    lens,          ///< position on the lens
    scatter,       ///< which density a direction is drawn from, and the direction
    light,         ///< next event: which emitter, where on it
    roulette,      ///< survival; whether next event samples an emitter at the vertex after, where it does not at each
    record,        ///< spatial filter (three words) and stochastic rounding of what scattered directions teach the tree
    light_record,  ///< as `record`, for next event's records
    bootstrap,     ///< the interval of the estimated error; keyed by block and resample instead of pixel and sample
    candidate,     ///< further directions to choose among, and which is taken; keyed by vertex and candidate
    glass_split,   ///< whether the lesser way out of glass is followed, too
    light_start,   ///< where a light path starts: which emitter, where on it
    light_scatter,   ///< the direction in which light leaves an emitter (vertex 0) or a surface
    light_roulette,  ///< survival of a light path
    splat_round,     ///< stochastic rounding of a splat
    lens_connect,    ///< the point of the lens that light paths are connected to
    filter_pick,     ///< the pixel that a connection goes to
};

/// Names one camera path: the same key gives the same path on any machine, thread or rank.
struct PathKey {
    std::uint64_t seed = 0;
    std::uint32_t pixel = 0;   ///< y * width + x
    std::uint32_t sample = 0;  ///< counts over all passes
};

using Draw = std::array<std::uint32_t, 4>;

/// Four independent uniform 32-bit numbers for (path, vertex, stream). Philox 4x32 with 7 rounds, the fewest that pass
/// BigCrush (Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3", table 2).
[[gnu::always_inline]] inline Draw draw(const PathKey& path, std::uint32_t vertex, Stream stream) {
    using Philox = r123::Philox4x32_R<7>;
    const Philox::ctr_type counter = {{path.pixel, path.sample, vertex, static_cast<std::uint32_t>(stream)}};
    const Philox::key_type key = {{static_cast<std::uint32_t>(path.seed), static_cast<std::uint32_t>(path.seed >> 32)}};
    const Philox::ctr_type r = Philox()(counter, key);
    return {r[0], r[1], r[2], r[3]};
}

/// Uniform in [0, 1), never 1: the top 24 bits as a float.
inline float to_unit(std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int32_t>(bits >> 8)) * 0x1p-24f;  // signed: one instruction
}

/// More random bits from those at hand (the finaliser of MurmurHash3).
inline std::uint32_t scrambled(std::uint32_t bits, std::uint32_t salt) {
    bits ^= salt * 0x9e3779b9u;
    bits = (bits ^ (bits >> 16)) * 0x85ebca6bu;
    bits = (bits ^ (bits >> 13)) * 0xc2b2ae35u;
    return bits ^ (bits >> 16);
}

}  // namespace treefarm
