// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// A fuzz target is one file tests/fuzz/<name>_fuzz.cpp with these two functions. CMake makes of it
///
///   - fuzz_<name>, always: our own driver, run by ctest with the label "fault", feeds it the seeds and a few thousand
///     mutations of them, the same ones every time;
///   - libfuzzer_<name>, in a build by clang with TREEFARM_FUZZ=ON: clang's libFuzzer. Seeds for it:
///     `fuzz_<name> --write-seeds DIRECTORY`.
///
/// The function under test gets any bytes. It must return; only what it is documented to throw may be caught.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace treefarm::fuzz {

/// Small valid inputs (and known bad ones) to begin with, made in code.
std::vector<std::string> seeds();

}  // namespace treefarm::fuzz
