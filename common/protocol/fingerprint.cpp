#include "common/protocol/fingerprint.h"

#include <immintrin.h>

#include <vector>

#include "common/base/bytes.h"
#include "common/base/hash.h"
#include "common/base/random.h"
#include "common/math/elementary.h"

namespace treefarm {

namespace {

std::uint64_t probe_mathematics() {
    ByteWriter values;
    for (std::uint32_t i = 0; i < 10000; ++i) {
        const Draw numbers = draw({.seed = 1, .pixel = i, .sample = 0}, 0, Stream::scatter);
        const float u = to_unit(numbers[0]);
        const SinCos turn = sincos_turn(u);
        values.put(numbers[3]);
        values.put(turn.sin);
        values.put(turn.cos);
        values.put(atan_quadrant(u));
        values.put(std::sqrt(u));
    }
    return hash_bytes(values.take());
}

std::string compiled_for() {
    std::string text = "gcc-compatible " __VERSION__;
#ifdef __AVX2__
    text += " avx2";
#endif
#ifdef __AVX512F__
    text += " avx512";
#endif
#ifdef __FMA__
    text += " fma";
#endif
    return text;
}

}  // namespace

Fingerprint own_fingerprint() {
    constexpr std::uint32_t kStickyFlags = 0x3f;  // exceptions that happened to occur do not change results
    return {kProgramVersion, compiled_for(), _mm_getcsr() & ~kStickyFlags, probe_mathematics()};
}

std::uint64_t Fingerprint::hash() const {
    ByteWriter writer;
    writer.put_string(version);
    writer.put_string(compiler);
    writer.put(float_control);
    writer.put(probes);
    return hash_bytes(writer.take());
}

}  // namespace treefarm
