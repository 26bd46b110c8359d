# SPDX-License-Identifier: Apache-2.0
# Language, warnings and the flags that keep results the same bits on every machine (docs/design/architecture.md).
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release or Debug" FORCE)
endif()

option(TREEFARM_TESTS "build the tests" ON)
option(TREEFARM_BENCH "build the benchmarks" ON)
option(TREEFARM_WERROR "treat warnings as errors" ON)
set(TREEFARM_ARCH "x86-64-v3" CACHE STRING "value of -march: x86-64-v3 is portable, native is not")
set(TREEFARM_SANITIZE "" CACHE STRING "address, undefined or thread: build with that sanitizer")
option(TREEFARM_TRAP "end the process at invalid operations, divisions by zero and overflows of floats" OFF)
# What computes no bit of an image or of a message: reading and writing of files, words, pages.
set(TREEFARM_COLD_MODULES runs config plan input coordinator report serve cli)
set(TREEFARM_COLD_OF "" CACHE PATH "a finished build whose libraries of these modules are linked, instead of compiling them")
option(TREEFARM_FUZZ "build the fuzz targets with libFuzzer too; needs clang" OFF)

include(cmake/refuse_fast_math.cmake)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

set(TREEFARM_LEVEL "-O3" CACHE STRING "level of release builds, but for cold files (cmake/compilation.cmake)")
set(CMAKE_CXX_FLAGS_RELEASE "${TREEFARM_LEVEL}")
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g -D_GLIBCXX_ASSERTIONS")

add_library(treefarm_flags INTERFACE)
# -ffp-contract=off: a fused multiply-add rounds once where two operations round twice; whether it is used must not
# depend on the compiler's mood. -fno-math-errno and -fno-trapping-math change no result: they say that nobody reads
# errno or floating-point flags, so that square roots are one instruction and choices need no branch. Asserts are on in Debug and in sanitizer builds.
set(trapping -fno-trapping-math)
if(TREEFARM_TRAP)
    # Nothing may be computed that the program does not ask for: no division before its condition is known, none in
    # lanes of a vector that nobody reads.
    if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
        set(trapping -ffp-exception-behavior=strict -fno-vectorize -fno-slp-vectorize -g1)
    else()
        set(trapping -ftrapping-math -fno-tree-vectorize -g1)
    endif()
    target_compile_definitions(treefarm_flags INTERFACE TREEFARM_TRAPS)
endif()
target_compile_options(treefarm_flags INTERFACE -march=${TREEFARM_ARCH} -ffp-contract=off -fno-math-errno ${trapping} -Wall -Wextra -Wconversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 warns of overlapping copies, bounds and overflows inside std::string's operator+ (GCC bug 105651), and takes the
    # alternatives that a std::variant does not hold for values that may be read (GCC bug 80635).
    target_compile_options(treefarm_flags INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread
                           -Wno-array-bounds -Wno-maybe-uninitialized)
    # Its way of clearing a struct of a hundred bytes, `rep stos`, was a third of what sampling a mesh emitter took.
    set(inline_up_to vector_loop:1024:noalign,libcall:-1:noalign)
    target_compile_options(treefarm_flags INTERFACE -mmemset-strategy=${inline_up_to} -mmemcpy-strategy=${inline_up_to})
endif()
if(TREEFARM_WERROR)
    target_compile_options(treefarm_flags INTERFACE -Werror)
endif()
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT TREEFARM_SANITIZE)
    target_compile_definitions(treefarm_flags INTERFACE NDEBUG)
endif()
if(TREEFARM_SANITIZE)
    target_compile_options(treefarm_flags INTERFACE -fsanitize=${TREEFARM_SANITIZE} -fno-omit-frame-pointer -g
                           -fno-sanitize-recover=all)
    target_link_options(treefarm_flags INTERFACE -fsanitize=${TREEFARM_SANITIZE})
endif()
if(TREEFARM_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
        message(FATAL_ERROR "TREEFARM_FUZZ needs clang: configure with -DCMAKE_CXX_COMPILER=clang++")
    endif()
    target_compile_options(treefarm_flags INTERFACE -fsanitize=fuzzer-no-link,address,undefined
                           -fno-sanitize-recover=undefined -g1)
    target_link_options(treefarm_flags INTERFACE -fsanitize=address,undefined)
endif()
