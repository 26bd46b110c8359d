// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace treefarm {

/// Version of the program, from CMakeLists.txt, as printed by `treefarm --version`.
extern const char* const kProgramVersion;

/// Everything besides job and scene that decides the bits of a result. Work done under equal fingerprints is
/// interchangeable (docs/design/architecture.md, "same bits"). Embree's instruction set is part of the job (farm.isa)
/// and not included.
struct Fingerprint {
    std::string version;              ///< of this program
    std::string source;               ///< `git describe` of the source, or "release"
    std::string options;              ///< build options
    std::string embree;               ///< version of the loaded library
    std::string compiler;             ///< name, version and target instruction set
    std::uint64_t program = 0;        ///< hash of the program's bytes, which tells builds of one version apart
    std::uint32_t float_control = 0;  ///< rounding mode, flush-to-zero and denormals-are-zero of MXCSR
    std::uint64_t probes = 0;         ///< hash of Treefarm's elementary functions at 10^4 points

    std::uint64_t hash() const;
    /// Text after "treefarm" in the output of `treefarm --version`.
    std::string text() const;
};

/// Fingerprint of this process and the calling thread. `source` and `options` are known to the main program only.
Fingerprint own_fingerprint(const std::string& source = "", const std::string& options = "",
                            const std::string& embree = "");

}  // namespace treefarm
