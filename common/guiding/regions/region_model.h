// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/base/bytes.h"
#include "common/guiding/statistics/record_units.h"
#include "common/math/vec.h"

namespace treefarm {

/// Number of emitter clusters. A region's probabilities, in parts of kLightProbabilityOne with this sum, are [0] for a
/// choice among all emitters as without learning, and [c + 1] for a choice within cluster c
/// (worker/lights/light_tree.h).
inline constexpr std::uint16_t kLightProbabilityOne = 1 << 15;
using LightProbabilities = std::array<std::uint16_t, kLightClusters + 1>;

/// Data about the image before a pass, for decisions on the whole image. Empty in the first pass, and if there is no
/// such decision.
struct ImageFacts {
    std::uint32_t columns = 0;          ///< blocks per row
    std::vector<float> inverse_levels;  ///< reciprocal light level of each block of pixels (levels_of()), row by row
    std::uint8_t next_event = 0;        ///< code in kNextEventSamples for passes without regions

    bool operator==(const ImageFacts&) const = default;
};

/// The part common to all models: a binary tree over a cube of space, with axes cycling x, y, z and midpoint splits.
/// Its leaves are the regions, which carry what is learned besides directions. Plain values, fixed during a pass; node
/// and region indices are equal on every rank. Regions are numbered in depth-first order. A guide's model derives from
/// this.
struct RegionModel {
    /// Node of the tree: child[0] is the lower half. A leaf has child[0] == 0 and its region in child[1].
    struct Node {
        std::uint32_t child[2] = {0, 0};
        bool is_leaf() const { return child[0] == 0; }
        bool operator==(const Node&) const = default;
    };

    std::uint32_t pass = 0;   ///< pass that this model guides, and whose records build the next model
    bool trained = false;     ///< false before the first pass: it must not guide
    Vec3 origin{0.0f};        ///< lower corner of the cube
    float extent = 1.0f;      ///< edge of the cube, > 0
    std::vector<Node> nodes;  ///< [0] is the root
    std::vector<std::int16_t> quantum_exponent;  ///< per region: records are counted in units of 2^e
    std::vector<float> bsdf_fraction;  ///< per region: probability of sampling the BSDF instead of the guide, (0, 1]

    /// Emitter choice per region; empty: not learned.
    std::vector<LightProbabilities> light_probabilities;
    /// Mean of the records L / p per region, the integral of radiance over directions; 0: unknown. Empty: not needed
    /// (path_recorder.h).
    std::vector<float> flux;

    /// Code in kNextEventSamples per region; empty: no decision, one sample per vertex.
    std::vector<std::uint8_t> next_event;
    ImageFacts image;

    /// Number of regions according to the nodes.
    std::uint32_t leaf_count() const { return static_cast<std::uint32_t>((nodes.size() + 1) / 2); }
    bool learns_lights() const { return !light_probabilities.empty(); }
    bool decides_next_event() const { return !next_event.empty(); }
    bool operator==(const RegionModel&) const = default;
};

inline constexpr int kMassBits = 30;  ///< probabilities of cells are integers, in units of 2^-30
inline constexpr std::uint32_t kWholeMass = 1u << kMassBits;  ///< probability 1
inline constexpr int kMaxSpatialDepth = 60;                   ///< 20 halvings of each axis: floats have 24 bits

/// Sets the model's cube around `bounds`; edge 1 if the bounds have no extent.
void set_cube(RegionModel& model, const Box3& bounds);

inline constexpr int kMostQuantumExponent = 200;  ///< no mean of floats needs one so far from 0
std::int16_t quantum_exponent_for(float mean_record);
/// Exponent e for the next pass, from the `records` of a pass with the sum `total` in units of 2^`exponent`; `exponent`
/// itself if there were none.
std::int16_t learned_exponent(double total, std::uint64_t records, std::int16_t exponent);
/// Mean record of a pass, with the same arguments; `before` if nothing was recorded.
float learned_flux(double total, std::uint64_t records, std::int16_t exponent, float before);

/// Codec of the common part, for the beginning and the middle of a guide's own. The reader checks all structural rules
/// and throws FormatError, except for the number of exponents and fractions, which it returns as the number of regions.
void write_regions(ByteWriter& out, const RegionModel& model);
std::uint32_t read_regions(ByteReader& in, RegionModel& model);
/// Writes the parts that only some jobs learn: choice of emitters, flux, number of light samples.
void write_optional(ByteWriter& out, const RegionModel& model);
void read_optional(ByteReader& in, RegionModel& model, std::uint32_t regions);

/// Packs a model for wire and file: `magic` identifies the guide, `version` the format; the rest is compressed.
Bytes pack_model(std::uint32_t magic, std::uint8_t version, const Bytes& raw);
/// The argument `raw` of pack_model(). Throws FormatError if `packed` has another magic number or version, or is
/// damaged.
Bytes unpack_model(std::uint32_t magic, std::uint8_t version, std::span<const std::uint8_t> packed);

}  // namespace treefarm
