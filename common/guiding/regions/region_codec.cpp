// SPDX-License-Identifier: Apache-2.0
#include <zstd.h>

#include <cmath>
#include <cstdlib>

#include "common/decide/next_event/next_event_sums.h"
#include "common/guiding/regions/region_model.h"

namespace treefarm {
namespace {

/// Greatest size of an unpacked model: more than a tree of 2^31 cells needs, so a larger claim is a malformed message.
constexpr std::uint64_t kMaxRawBytes = std::uint64_t{1} << 34;
/// Bits of the optional parts of a model.
constexpr int kHasLights = 1, kHasFlux = 2, kHasNextEvent = 4, kHasImage = 8;
constexpr int kCompressionLevel = 1;  // fast: a broadcast waits for it

void write_nodes(ByteWriter& out, const RegionModel& model) {
    // Preorder, one bit per node (1: inner), packed into bytes.
    out.put_varint(model.nodes.size());
    std::vector<std::uint8_t> bits((model.nodes.size() + 7) / 8);
    std::vector<std::uint32_t> stack{0};
    for (std::size_t i = 0; !stack.empty(); ++i) {
        const RegionModel::Node& node = model.nodes[stack.back()];
        stack.pop_back();
        if (node.is_leaf()) continue;
        bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | (1u << (i % 8)));
        stack.push_back(node.child[1]);
        stack.push_back(node.child[0]);
    }
    out.put_array(std::span<const std::uint8_t>(bits));
}

struct NodeReader {
    const std::vector<std::uint8_t>& bits;
    std::size_t count;
    RegionModel& model;
    std::uint32_t regions = 0;

    std::uint32_t read(int depth) {
        const std::size_t i = model.nodes.size();
        if (i >= count || depth > kMaxSpatialDepth) throw FormatError("the spatial tree is malformed");
        model.nodes.emplace_back();
        if ((bits[i / 8] >> (i % 8)) & 1) {
            const std::uint32_t low = read(depth + 1);
            const std::uint32_t high = read(depth + 1);
            model.nodes[i] = {{low, high}};
        } else {
            model.nodes[i] = {{0, regions++}};
        }
        return static_cast<std::uint32_t>(i);
    }
};

}  // namespace

void write_regions(ByteWriter& out, const RegionModel& model) {
    out.put_varint(model.pass);
    out.put<std::uint8_t>(model.trained);
    for (int axis = 0; axis < 3; ++axis)
        out.put(model.origin[axis]);
    out.put(model.extent);
    write_nodes(out, model);
    out.put_array(std::span<const std::int16_t>(model.quantum_exponent));
    out.put_array(std::span<const float>(model.bsdf_fraction));
}

std::uint32_t read_regions(ByteReader& in, RegionModel& model) {
    model.pass = static_cast<std::uint32_t>(in.get_varint());
    model.trained = in.get<std::uint8_t>() != 0;
    for (int axis = 0; axis < 3; ++axis)
        model.origin[axis] = in.get<float>();
    model.extent = in.get<float>();
    if (!is_finite(model.origin) || !(model.extent > 0.0f) || !std::isfinite(model.extent))
        throw FormatError("a tree's cube is not finite");
    const std::uint64_t node_count = in.get_varint();
    const std::vector<std::uint8_t> bits = in.get_array<std::uint8_t>();
    if (node_count == 0 || node_count > 8 * bits.size() || bits.size() != (node_count + 7) / 8)
        throw FormatError("the spatial tree is malformed");
    NodeReader nodes{bits, static_cast<std::size_t>(node_count), model};
    nodes.read(0);
    if (model.nodes.size() != node_count) throw FormatError("the spatial tree is malformed");
    model.quantum_exponent = in.get_array<std::int16_t>();
    for (const std::int16_t exponent : model.quantum_exponent)
        if (std::abs(exponent) > kMostQuantumExponent) throw FormatError("a region's unit of records is out of range");
    model.bsdf_fraction = in.get_array<float>();
    if (model.bsdf_fraction.size() != model.quantum_exponent.size())
        throw FormatError("a tree's mixtures do not match its regions");
    for (const float fraction : model.bsdf_fraction)
        if (!(fraction > 0.0f && fraction <= 1.0f)) throw FormatError("a region's mixture is out of range");
    return nodes.regions;
}

void write_optional(ByteWriter& out, const RegionModel& model) {
    const bool has_image = model.image != ImageFacts{};
    const int present = (model.light_probabilities.empty() ? 0 : kHasLights) | (model.flux.empty() ? 0 : kHasFlux) |
                        (model.next_event.empty() ? 0 : kHasNextEvent) | (has_image ? kHasImage : 0);
    out.put(static_cast<std::uint8_t>(present));
    for (const LightProbabilities& probabilities : model.light_probabilities)
        for (const std::uint16_t part : probabilities)
            out.put(part);
    for (const float flux : model.flux)
        out.put(flux);
    for (const std::uint8_t code : model.next_event)
        out.put(code);
    if (!has_image) return;
    out.put_varint(model.image.columns);
    out.put(model.image.next_event);
    out.put_array(std::span<const float>(model.image.inverse_levels));
}

namespace {

std::uint8_t read_next_event(ByteReader& in) {
    const auto code = in.get<std::uint8_t>();
    if (code >= kNextEventSamples.size()) throw FormatError("a decision on next event is out of range");
    return code;
}

}  // namespace

void read_optional(ByteReader& in, RegionModel& model, std::uint32_t regions) {
    const auto present = in.get<std::uint8_t>();
    if ((present & ~(kHasLights | kHasFlux | kHasNextEvent | kHasImage)) != 0)
        throw FormatError("what a tree has learned is malformed");
    const std::size_t bytes = (present & kHasLights ? sizeof(LightProbabilities) : 0) +
                              (present & kHasFlux ? sizeof(float) : 0) + (present & kHasNextEvent ? 1 : 0);
    if (bytes != 0 && regions > in.remaining() / bytes) throw FormatError("what a tree has learned is cut short");
    if (present & kHasLights) model.light_probabilities.resize(regions);
    for (LightProbabilities& probabilities : model.light_probabilities) {
        std::uint32_t sum = 0;
        for (std::uint16_t& part : probabilities)
            sum += part = in.get<std::uint16_t>();
        if (sum != kLightProbabilityOne) throw FormatError("a region's choice of emitters does not sum to one");
    }
    if (present & kHasFlux) model.flux.resize(regions);
    for (float& flux : model.flux) {
        flux = in.get<float>();
        if (!(flux >= 0.0f && std::isfinite(flux))) throw FormatError("a region's flux is out of range");
    }
    if (present & kHasNextEvent) model.next_event.resize(regions);
    for (std::uint8_t& code : model.next_event)
        code = read_next_event(in);
    if (!(present & kHasImage)) return;
    model.image.columns = static_cast<std::uint32_t>(in.get_varint());
    model.image.next_event = read_next_event(in);
    model.image.inverse_levels = in.get_array<float>();
    for (const float level : model.image.inverse_levels)
        if (!(level >= 0.0f && std::isfinite(level))) throw FormatError("the light of a block is out of range");
}

Bytes pack_model(std::uint32_t magic, std::uint8_t version, const Bytes& raw) {
    ByteWriter header;
    header.put(magic);
    header.put(version);
    header.put<std::uint64_t>(raw.size());
    Bytes packed = header.take();
    const std::size_t at = packed.size();
    packed.resize(at + ZSTD_compressBound(raw.size()));
    const std::size_t size =
        ZSTD_compress(packed.data() + at, packed.size() - at, raw.data(), raw.size(), kCompressionLevel);
    if (ZSTD_isError(size)) throw RunError(std::string("compressing a tree failed: ") + ZSTD_getErrorName(size));
    packed.resize(at + size);
    return packed;
}

Bytes unpack_model(std::uint32_t magic, std::uint8_t version, std::span<const std::uint8_t> packed) {
    ByteReader header(packed);
    if (header.get<std::uint32_t>() != magic) throw FormatError("not a Treefarm tree");
    const auto found = header.get<std::uint8_t>();
    if (found != version) throw FormatError("a tree of version " + std::to_string(found) + " cannot be read");
    const auto raw_size = header.get<std::uint64_t>();
    const auto rest = header.get_rest();
    // The frame's own claim must agree before anything is allocated.
    if (raw_size > kMaxRawBytes || ZSTD_getFrameContentSize(rest.data(), rest.size()) != raw_size)
        throw FormatError("a tree's size is not what its header says");
    Bytes raw(raw_size);
    const std::size_t size = ZSTD_decompress(raw.data(), raw.size(), rest.data(), rest.size());
    if (ZSTD_isError(size) || size != raw_size) throw FormatError("a tree's compressed bytes are damaged");
    return raw;
}

}  // namespace treefarm
