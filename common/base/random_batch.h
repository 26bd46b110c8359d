// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/base/random.h"

namespace treefarm {

/// Number of paths that draw together: a multiple of the lanes of every vector register. Larger batches have fewer
/// steps with few paths left; above this size, large trees became slower (bench/log/speed.md, "what made paths
/// faster").
inline constexpr std::uint32_t kDrawBatch = 128;

/// Keys of the paths that draw, and the vertex of each.
struct KeyBatch {
    alignas(64) std::array<std::uint32_t, kDrawBatch> pixel{}, sample{}, vertex{};
};

/// Random numbers of a batch, word by word, so that the compiler vectorises loops over paths.
struct DrawBatch {
    alignas(64) std::array<std::array<std::uint32_t, kDrawBatch>, 4> word;

    Draw operator[](std::size_t i) const { return {word[0][i], word[1][i], word[2][i], word[3][i]}; }
};

/// draw() for the first `count` keys (Philox 4x32, 7 rounds), with vertex numbers increased by `offset`: the same
/// numbers in a fraction of the time. Entries from `count` on are undefined. Not inlined: it is long, is called once
/// per batch, and must not depend on its caller's inlining budget.
[[gnu::noinline]] inline void draw_batch(std::uint64_t seed, const KeyBatch& keys, std::uint32_t count,
                                         std::uint32_t offset, Stream stream, DrawBatch& out) {
    constexpr std::uint32_t kLanes = 8;
    for (std::uint32_t i = 0; i < (count + kLanes - 1) / kLanes * kLanes; ++i) {
        std::uint32_t c0 = keys.pixel[i], c1 = keys.sample[i], c2 = keys.vertex[i] + offset,
                      c3 = static_cast<std::uint32_t>(stream);
        auto k0 = static_cast<std::uint32_t>(seed), k1 = static_cast<std::uint32_t>(seed >> 32);
#pragma GCC unroll 7
        for (int round = 0; round < 7; ++round) {
            const std::uint64_t p0 = std::uint64_t{0xd2511f53u} * c0, p1 = std::uint64_t{0xcd9e8d57u} * c2;
            c0 = static_cast<std::uint32_t>(p1 >> 32) ^ c1 ^ k0;
            c2 = static_cast<std::uint32_t>(p0 >> 32) ^ c3 ^ k1;
            c1 = static_cast<std::uint32_t>(p1);
            c3 = static_cast<std::uint32_t>(p0);
            k0 += 0x9e3779b9u;
            k1 += 0xbb67ae85u;
        }
        out.word[0][i] = c0;
        out.word[1][i] = c1;
        out.word[2][i] = c2;
        out.word[3][i] = c3;
    }
}

}  // namespace treefarm
