// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/fingerprint.h"

#include <immintrin.h>

#include <filesystem>
#include <fstream>

#include "common/base/bytes.h"
#include "common/base/hash.h"
#include "common/base/random.h"
#include "common/math/elementary.h"

namespace treefarm {

const char* const kProgramVersion = TREEFARM_VERSION;

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

/// Hash of this program's file; 0 if the system gives no access.
std::uint64_t hash_program() {
    const std::filesystem::path self = "/proc/self/exe";
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(self, error);
    if (error) return 0;
    Bytes bytes(size);
    std::ifstream(self, std::ios::binary)
        .read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    return hash_bytes(bytes);
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

Fingerprint own_fingerprint(const std::string& source, const std::string& options, const std::string& embree) {
    constexpr std::uint32_t kStickyFlags = 0x3f;  // exception flags do not influence results
    return {kProgramVersion,    source, options, embree, compiled_for(), hash_program(), _mm_getcsr() & ~kStickyFlags,
            probe_mathematics()};
}

std::string Fingerprint::text() const {
    return version + " (" + source + ")\n" + options + ", " + compiler + ", Embree " + embree + "\nprogram " +
           hash_text(program) + ", fingerprint " + hash_text(hash());
}

std::uint64_t Fingerprint::hash() const {
    ByteWriter writer;
    for (const std::string& text : {version, source, options, embree, compiler})
        writer.put_string(text);
    writer.put(program);
    writer.put(float_control);
    writer.put(probes);
    return hash_bytes(writer.take());
}

}  // namespace treefarm
