// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Random123/philox.h>

#include <array>
#include <concepts>
#include <cstdint>

namespace treefarm {

/// Purpose of a random number. Each purpose has its own stream, so that switching an effect on never changes the
/// numbers of another effect (docs/design/guiding.md, "random streams").
enum class Stream : std::uint32_t {
    camera,    ///< position in the pixel filter
    lens,      ///< position on the lens
    scatter,   ///< choice of the density that a direction is drawn from, and the direction
    light,     ///< next event: choice of an emitter, and of a point on it
    roulette,  ///< survival; whether the next vertex samples an emitter, if next event is used at only some vertices
    record,    ///< spatial filter (three words) and stochastic rounding of a guiding record of a scattered direction
    light_record,    ///< as `record`, for records of next event
    bootstrap,       ///< interval of the estimated error; keyed by block and resample instead of pixel and sample
    candidate,       ///< further candidate directions, and the choice among them; keyed by vertex and candidate
    glass_split,     ///< whether the less likely branch at glass is followed, too
    light_start,     ///< start of a light path: choice of an emitter, and of a point on it
    light_scatter,   ///< direction in which a light path leaves an emitter (vertex 0) or a surface
    light_roulette,  ///< survival of a light path
    splat_round,     ///< stochastic rounding of a splat
    lens_connect,    ///< point of the lens to which light paths are connected
    filter_pick,     ///< pixel that a connection is added to
};

/// Identity of a camera path: equal keys give equal paths on any machine, thread or rank.
struct PathKey {
    std::uint64_t seed = 0;
    std::uint32_t pixel = 0;   ///< y * width + x
    std::uint32_t sample = 0;  ///< index over all passes
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

/// Source of a path's random numbers: PathKey, or a Markov chain's state (Kelemen et al. 2002, "A simple and robust
/// mutation strategy for the Metropolis light transport algorithm"). Its draw() gives four numbers for a vertex and a
/// stream, always the same ones; `sample` chooses the half of the samples that splats are added to. Copied with splats.
template <class N>
concept Numbers = std::copyable<N> && requires(const N& numbers, std::uint32_t vertex, Stream stream) {
    { draw(numbers, vertex, stream) } -> std::same_as<Draw>;
    { numbers.pixel } -> std::convertible_to<std::uint32_t>;
    { numbers.sample } -> std::convertible_to<std::uint32_t>;
};

/// Uniform float in [0, 1), never 1: the top 24 bits.
inline float to_unit(std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int32_t>(bits >> 8)) * 0x1p-24f;  // signed: one instruction
}

/// Further random bits derived from `bits` and `salt` (the finaliser of MurmurHash3).
inline std::uint32_t scrambled(std::uint32_t bits, std::uint32_t salt) {
    bits ^= salt * 0x9e3779b9u;
    bits = (bits ^ (bits >> 16)) * 0x85ebca6bu;
    bits = (bits ^ (bits >> 13)) * 0xc2b2ae35u;
    return bits ^ (bits >> 16);
}

}  // namespace treefarm
