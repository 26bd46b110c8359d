#pragma once

#include <cstdint>
#include <string>

namespace treefarm {

/// Version of the program, as `treefarm --version` prints it.
inline constexpr const char* kProgramVersion = "0.1.0";

/// What decides the bits of a result besides job and scene. Work done under equal fingerprints is interchangeable
/// (docs/architecture.md, "same bits"). Embree's instruction set is part of the job (farm.isa), so it is not in here.
struct Fingerprint {
    std::string version;          ///< of this program
    std::string compiler;         ///< its name, version and the instruction set it compiled for
    std::uint32_t float_control;  ///< rounding mode, flush-to-zero and denormals-are-zero of MXCSR
    std::uint64_t probes;         ///< hash of our elementary functions at 10^4 points

    std::uint64_t hash() const;
};

/// Of this process, for the calling thread.
Fingerprint own_fingerprint();

}  // namespace treefarm
