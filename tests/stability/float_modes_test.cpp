// SPDX-License-Identifier: Apache-2.0
// What the processor's and the compiler's floating-point modes may not change.
#include <xmmintrin.h>

#include "tests/support/command.h"
#include "tests/support/hard_case.h"
#include "tests/support/material_scenes.h"

namespace treefarm {
namespace {

/// Flush to zero and denormals are zero, while it lives.
class Flushing {
  public:
    Flushing() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040u); }
    ~Flushing() { _mm_setcsr(before_); }

  private:
    unsigned before_;
};

/// 26 | Denormals flushed to zero or not
/// Others: bins of a hierarchy were counted differently where denormals became 0 (Mitsuba 3 54dda7b7f).
/// Here: a worker's fingerprint holds the mode, so that workers of both do not mix; nothing divides by what may
/// flush.
/// Holds: a room with metal, glass and plastic, guided, and the same at 2^-40 of its size, have no invalid sample
/// with flushing; means with and without are equal within 4.5 standard errors, and at size 1 the images are the
/// same bits.
TEST(FloatModes, FlushedDenormals) {
    for (const float scale : {1.0f, 0x1p-40f}) {
        Scene scene = scale == 1.0f ? test::glossy_room() : test::cornell_box(scale, Vec3(0.0f));
        test::set_film(scene, 16, 16);
        const Job job = test::guided_job(31, 8, NextEvent::always);
        const test::LocalRender plain = test::render_locally(scene, job);
        const test::LocalRender flushed = [&] {
            const Flushing flushing;
            return test::render_locally(scene, job);
        }();
        EXPECT_EQ(test::invalid_samples(plain), 0u) << scale;
        EXPECT_EQ(test::invalid_samples(flushed), 0u) << scale;
        const test::ImageMean a = test::mean_of(plain.image), b = test::mean_of(flushed.image);
        EXPECT_LT(std::abs(a.value - b.value), 4.5 * std::hypot(a.error, b.error) + 1e-9) << scale;
        int different = 0;
        for (std::size_t i = 0; i < plain.image.mean.size(); ++i)
            different += plain.image.mean[i] != flushed.image.mean[i];
        if (scale == 1.0f) {
            EXPECT_EQ(different, 0);
            test::figure("pixels that differ", different);
        }
    }
}

/// 5 | Associative mathematics
/// Others: the compiler turned 1 - cos^2 + alpha^2 cos^2 into what cancels (GCC, Cycles #130389).
/// Here: the build refuses -ffast-math and its parts, and the headers refuse to be compiled with it.
/// Holds: cmake fails with a message that names the flag for -ffast-math, -Ofast, -funsafe-math-optimizations and
/// -fassociative-math; a translation unit that includes our vectors does not compile with -ffast-math.
TEST(FloatModes, FastMathIsRefused) {
    int refused = 0;
    const std::string source = TREEFARM_SOURCE_DIR;
    for (const char* flag : {"-ffast-math", "-Ofast", "-funsafe-math-optimizations", "-fassociative-math"}) {
        // Only the options are read: no compiler need be looked for, nor libraries.
        const auto [code, text] = test::run_command("cmake -DCMAKE_CXX_FLAGS=" + std::string(flag) + " -P '" + source +
                                                    "/cmake/refuse_fast_math.cmake'");
        EXPECT_NE(code, 0) << flag;
        EXPECT_NE(text.find(flag), std::string::npos) << text;
        refused += code != 0;
    }
    const std::string compile =
        "printf '#include \"common/math/vec.h\"\\n' | c++ -std=c++20 -I '" + source + "' -fsyntax-only -x c++ -";
    EXPECT_EQ(test::run_command(compile).code, 0);
    EXPECT_NE(test::run_command(compile + " -ffast-math").code, 0);
    test::figure("flags that cmake refuses", refused);
}

}  // namespace
}  // namespace treefarm
