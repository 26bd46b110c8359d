// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/base/bytes.h"
#include "common/guiding/statistics/record_units.h"
#include "common/math/vec.h"

namespace treefarm {

/// How next event chooses an emitter in a region, in parts of kLightProbabilityOne, to which they sum: [0] among all
/// of them, as where nothing is learned, [c + 1] among those of cluster c (worker/lights/light_tree.h).
inline constexpr std::uint16_t kLightProbabilityOne = 1 << 15;
using LightProbabilities = std::array<std::uint16_t, kLightClusters + 1>;

/// What is known of the image before a pass, for decisions that hold for all of it. Empty in a first pass, and where
/// nothing is decided.
struct ImageFacts {
    std::uint32_t columns = 0;          ///< of the blocks
    std::vector<float> inverse_levels;  ///< one over the light of each block of pixels (levels_of()), row by row
    std::uint8_t next_event = 0;        ///< where no region says it: code of kNextEventSamples

    bool operator==(const ImageFacts&) const = default;
};

/// What all guides share: a binary tree over a cube of space, axes cycling x, y, z, midpoint splits, whose leaves are
/// the regions, and what is learned of each besides directions. Plain values, frozen for a pass; node and region
/// indices mean the same on every rank. Regions are numbered in depth-first order. A guide's model is this and its own
/// part.
struct RegionModel {
    /// child[0] is the lower half. A leaf has child[0] == 0 and its region in child[1].
    struct Node {
        std::uint32_t child[2] = {0, 0};
        bool is_leaf() const { return child[0] == 0; }
        bool operator==(const Node&) const = default;
    };

    std::uint32_t pass = 0;                      ///< the pass that this model guides and that builds the next one
    bool trained = false;                        ///< false before the first pass: do not guide by it
    Vec3 origin{0.0f};                           ///< lower corner of the cube
    float extent = 1.0f;                         ///< edge of the cube, > 0
    std::vector<Node> nodes;                     ///< [0] is the root
    std::vector<std::int16_t> quantum_exponent;  ///< per region: records are counted in units of 2^e
    std::vector<float> bsdf_fraction;  ///< per region: probability of sampling the BSDF rather than the guide, (0, 1]

    /// Per region; empty: nothing is learned of emitters.
    std::vector<LightProbabilities> light_probabilities;
    /// Per region: mean of the records L / p, the integral of radiance over directions; 0: nothing is known. Empty:
    /// nothing asks for it (path_recorder.h).
    std::vector<float> flux;

    /// Per region: code of kNextEventSamples. Empty: nothing is decided, one sample per vertex.
    std::vector<std::uint8_t> next_event;
    ImageFacts image;

    /// Regions, by the nodes.
    std::uint32_t leaf_count() const { return static_cast<std::uint32_t>((nodes.size() + 1) / 2); }
    bool learns_lights() const { return !light_probabilities.empty(); }
    bool decides_next_event() const { return !next_event.empty(); }
    bool operator==(const RegionModel&) const = default;
};

inline constexpr int kMassBits = 30;         ///< probabilities of cells are integers of 2^30
inline constexpr int kMaxSpatialDepth = 60;  ///< 20 halvings of each axis: floats have 24 bits

/// A cube around `bounds` as the region model's, of edge 1 where the bounds have no extent.
void set_cube(RegionModel& model, const Box3& bounds);

inline constexpr int kMostQuantumExponent = 200;  ///< no mean of floats asks for one so far from 0
std::int16_t quantum_exponent_for(float mean_record);
/// The exponent that suits what a pass recorded: `records` of them with the sum `total`, in units of 2^`exponent`;
/// `exponent` itself where nothing was.
std::int16_t learned_exponent(double total, std::uint64_t records, std::int16_t exponent);
/// The mean record of a pass, of the same arguments; `before` where nothing was recorded.
float learned_flux(double total, std::uint64_t records, std::int16_t exponent, float before);

/// Codec of the shared part, as the beginning and the middle of a guide's own. Reading checks every structural rule and
/// throws FormatError, but for how many exponents and fractions there are: returns the number of regions instead.
void write_regions(ByteWriter& out, const RegionModel& model);
std::uint32_t read_regions(ByteReader& in, RegionModel& model);
/// What only some jobs learn: the choice of emitters, flux, how often next event is asked.
void write_optional(ByteWriter& out, const RegionModel& model);
void read_optional(ByteReader& in, RegionModel& model, std::uint32_t regions);

/// How a model travels and is stored: `magic` tells guides apart, `version` what is in it; the rest is compressed.
Bytes pack_model(std::uint32_t magic, std::uint8_t version, const Bytes& raw);
/// The bytes that pack_model() was given; FormatError if `packed` is not of this magic and version, or damaged.
Bytes unpack_model(std::uint32_t magic, std::uint8_t version, std::span<const std::uint8_t> packed);

}  // namespace treefarm
