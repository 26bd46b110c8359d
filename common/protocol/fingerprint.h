// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace treefarm {

/// Version of the program, as `treefarm --version` prints it: that of the project in CMakeLists.txt.
extern const char* const kProgramVersion;

/// Origin of a result: all that decides its bits besides job and scene. Work done under equal fingerprints is
/// interchangeable (docs/design/architecture.md, "same bits"). Embree's instruction set is part of the job (farm.isa),
/// so it is not in here.
struct Fingerprint {
    std::string version;              ///< of this program
    std::string source;               ///< `git describe` of what it was built from, or "release"
    std::string options;              ///< how it was built
    std::string embree;               ///< version of the library that is loaded
    std::string compiler;             ///< its name, version and the instruction set it compiled for
    std::uint64_t program = 0;        ///< hash of the program's bytes: two builds of one version are told apart
    std::uint32_t float_control = 0;  ///< rounding mode, flush-to-zero and denormals-are-zero of MXCSR
    std::uint64_t probes = 0;         ///< hash of our elementary functions at 10^4 points

    std::uint64_t hash() const;
    /// For a person: what stands after "treefarm" in `treefarm --version`.
    std::string text() const;
};

/// Fingerprint of this process, for the calling thread. What only the program itself knows is handed in.
Fingerprint own_fingerprint(const std::string& source = "", const std::string& options = "",
                            const std::string& embree = "");

}  // namespace treefarm
