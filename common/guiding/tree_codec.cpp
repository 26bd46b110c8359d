// SPDX-License-Identifier: Apache-2.0
#include <zstd.h>

#include <cmath>
#include <cstdlib>

#include "common/guiding/sd_tree.h"

namespace treefarm {
namespace {

constexpr std::uint32_t kMagic = 0x52544654;  // "TFTR"
constexpr std::uint8_t kVersion = 4;
/// No tree of 2^31 cells needs more; a claim above it is a broken or hostile message.
constexpr std::uint64_t kMaxRawBytes = std::uint64_t{1} << 34;
constexpr int kCompressionLevel = 1;  // fast: a broadcast waits for it

void write_nodes(ByteWriter& out, const SdTree& tree) {
    // Preorder, a bit a node (1: inner), in bytes of eight.
    out.put_varint(tree.nodes.size());
    std::vector<std::uint8_t> bits((tree.nodes.size() + 7) / 8);
    std::vector<std::uint32_t> stack{0};
    for (std::size_t i = 0; !stack.empty(); ++i) {
        const SdTree::Node& node = tree.nodes[stack.back()];
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
    SdTree& tree;
    std::uint32_t regions = 0;

    std::uint32_t read(int depth) {
        const std::size_t i = tree.nodes.size();
        if (i >= count || depth > kMaxSpatialDepth) throw FormatError("the spatial tree is malformed");
        tree.nodes.emplace_back();
        if ((bits[i / 8] >> (i % 8)) & 1) {
            const std::uint32_t low = read(depth + 1);
            const std::uint32_t high = read(depth + 1);
            tree.nodes[i] = {{low, high}};
        } else {
            tree.nodes[i] = {{0, regions++}};
        }
        return static_cast<std::uint32_t>(i);
    }
};

/// Cuts the list of view depths into T2s: one is complete when its views cover the square.
void find_views(SdTree& tree, std::uint32_t regions) {
    constexpr std::uint64_t kSquare = std::uint64_t{1} << (2 * kMaxViewDepth);
    if (tree.view_fraction.size() != tree.view_depth.size())
        throw FormatError("a tree's views do not match its mixtures");
    tree.view_begin.push_back(0);
    std::uint64_t covered = 0;
    for (std::uint32_t v = 0; v < tree.view_count(); ++v) {
        const int depth = tree.view_depth[v];
        const float a = tree.view_fraction[v], bsdf = tree.bsdf_fraction[regions + v];
        if (depth > kMaxViewDepth) throw FormatError("a view's depth is out of range");
        if (!(a >= 0.0f && a <= 1.0f - bsdf)) throw FormatError("a view's mixture is out of range");
        const std::uint64_t size = std::uint64_t{1} << (2 * (kMaxViewDepth - depth));
        if (covered % size != 0) throw FormatError("views overlap");
        covered += size;
        if (covered < kSquare) continue;
        covered = 0;
        tree.view_begin.push_back(v + 1);
    }
    std::uint32_t next = 0;  // T2s are numbered as they come
    for (std::uint32_t r = 0; r < tree.view_set.size(); ++r) {
        const std::uint32_t set = tree.view_set[r];
        const bool known = r != 0 && set == tree.view_set[r - 1];
        if (set != SdTree::kNoViews && !known && set != next++) throw FormatError("a region's views are out of order");
    }
    if (covered != 0 || tree.view_set.size() != regions || next != tree.view_set_count())
        throw FormatError("a tree's views do not match its regions");
}

/// Cuts the list of cell depths into distributions: one is complete when its cells cover the square.
void find_distributions(SdTree& tree) {
    constexpr std::uint64_t kSquare = std::uint64_t{1} << (2 * kMaxDirectionDepth);
    std::uint64_t covered = 0, mass = 0;
    tree.cell_begin = {0};
    for (std::uint32_t c = 0; c < tree.cell_count(); ++c) {
        const int depth = tree.cell_depth[c];
        if (depth < 1 || depth > kMaxDirectionDepth) throw FormatError("a cell's depth is out of range");
        const std::uint64_t size = std::uint64_t{1} << (2 * (kMaxDirectionDepth - depth));
        if (covered % size != 0) throw FormatError("a quadtree's cells overlap");
        covered += size;
        mass += tree.cell_mass[c];
        if (covered < kSquare) continue;
        if (mass != std::uint64_t{1} << kMassBits) throw FormatError("a quadtree's probabilities do not sum to one");
        covered = mass = 0;
        tree.cell_begin.push_back(c + 1);
    }
    if (covered != 0 || tree.cell_begin.size() != std::size_t{tree.distribution_count()} + 1)
        throw FormatError("the quadtrees do not match the spatial tree");
}

void write_views(ByteWriter& out, const SdTree& tree) {
    out.put_array(std::span<const std::uint8_t>(tree.view_depth));
    if (tree.view_count() == 0) return;
    out.put_array(std::span<const float>(tree.view_fraction));
    for (const std::uint32_t set : tree.view_set)
        out.put_varint(set == SdTree::kNoViews ? 0 : std::uint64_t{set} + 1);
}

void write_lights(ByteWriter& out, const SdTree& tree) {
    out.put<std::uint8_t>(!tree.light_probabilities.empty());
    for (const LightProbabilities& probabilities : tree.light_probabilities)
        for (const std::uint16_t part : probabilities)
            out.put(part);
}

void read_lights(ByteReader& in, SdTree& tree, std::uint32_t regions) {
    const auto present = in.get<std::uint8_t>();
    if (present > 1) throw FormatError("a tree's choice of emitters is malformed");
    if (present == 0) return;
    if (regions > in.remaining() / sizeof(LightProbabilities))
        throw FormatError("a tree's choice of emitters is cut short");
    tree.light_probabilities.resize(regions);
    for (LightProbabilities& probabilities : tree.light_probabilities) {
        std::uint32_t sum = 0;
        for (std::uint16_t& part : probabilities)
            sum += part = in.get<std::uint16_t>();
        if (sum != kLightProbabilityOne) throw FormatError("a region's choice of emitters does not sum to one");
    }
}

}  // namespace

Bytes encode_tree(const SdTree& tree) {
    ByteWriter out;
    out.put_varint(tree.pass);
    out.put<std::uint8_t>(tree.trained);
    for (int axis = 0; axis < 3; ++axis)
        out.put(tree.origin[axis]);
    out.put(tree.extent);
    write_nodes(out, tree);
    out.put_array(std::span<const std::int16_t>(tree.quantum_exponent));
    out.put_array(std::span<const float>(tree.bsdf_fraction));
    write_views(out, tree);
    write_lights(out, tree);
    out.put_array(std::span<const std::uint8_t>(tree.cell_depth));
    for (const std::uint32_t mass : tree.cell_mass)
        out.put_varint(mass);
    const Bytes raw = out.take();

    ByteWriter header;
    header.put(kMagic);
    header.put(kVersion);
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

SdTree decode_tree(std::span<const std::uint8_t> bytes) {
    ByteReader header(bytes);
    if (header.get<std::uint32_t>() != kMagic) throw FormatError("not a Treefarm tree");
    const auto version = header.get<std::uint8_t>();
    if (version != kVersion) throw FormatError("a tree of version " + std::to_string(version) + " cannot be read");
    const auto raw_size = header.get<std::uint64_t>();
    const auto packed = header.get_rest();
    // The frame's own claim must agree before anything is allocated.
    if (raw_size > kMaxRawBytes || ZSTD_getFrameContentSize(packed.data(), packed.size()) != raw_size)
        throw FormatError("a tree's size is not what its header says");
    Bytes raw(raw_size);
    const std::size_t size = ZSTD_decompress(raw.data(), raw.size(), packed.data(), packed.size());
    if (ZSTD_isError(size) || size != raw_size) throw FormatError("a tree's compressed bytes are damaged");

    ByteReader in(raw);
    SdTree tree;
    tree.pass = static_cast<std::uint32_t>(in.get_varint());
    tree.trained = in.get<std::uint8_t>() != 0;
    for (int axis = 0; axis < 3; ++axis)
        tree.origin[axis] = in.get<float>();
    tree.extent = in.get<float>();
    if (!is_finite(tree.origin) || !(tree.extent > 0.0f) || !std::isfinite(tree.extent))
        throw FormatError("a tree's cube is not finite");
    const std::uint64_t node_count = in.get_varint();
    const std::vector<std::uint8_t> bits = in.get_array<std::uint8_t>();
    if (node_count == 0 || node_count > 8 * bits.size() || bits.size() != (node_count + 7) / 8)
        throw FormatError("the spatial tree is malformed");
    NodeReader nodes{bits, static_cast<std::size_t>(node_count), tree};
    nodes.read(0);
    if (tree.nodes.size() != node_count) throw FormatError("the spatial tree is malformed");
    tree.quantum_exponent = in.get_array<std::int16_t>();
    for (const std::int16_t exponent : tree.quantum_exponent)
        if (std::abs(exponent) > kMostQuantumExponent) throw FormatError("a region's unit of records is out of range");
    tree.bsdf_fraction = in.get_array<float>();
    if (tree.bsdf_fraction.size() != tree.quantum_exponent.size())
        throw FormatError("a tree's mixtures do not match its regions");
    for (const float fraction : tree.bsdf_fraction)
        if (!(fraction > 0.0f && fraction <= 1.0f)) throw FormatError("a region's mixture is out of range");
    tree.view_depth = in.get_array<std::uint8_t>();
    if (tree.quantum_exponent.size() != nodes.regions + tree.view_depth.size())
        throw FormatError("a tree's regions do not match its nodes");
    if (tree.view_count() != 0) {
        tree.view_fraction = in.get_array<float>();
        for (std::uint32_t r = 0; r < nodes.regions; ++r)
            tree.view_set.push_back(static_cast<std::uint32_t>(in.get_varint()) - 1);
        find_views(tree, nodes.regions);
    }
    read_lights(in, tree, nodes.regions);
    tree.cell_depth = in.get_array<std::uint8_t>();
    if (tree.cell_depth.size() > in.remaining()) throw FormatError("a tree's cells are cut short");
    tree.cell_mass.reserve(tree.cell_depth.size());
    for (std::size_t c = 0; c < tree.cell_depth.size(); ++c) {
        const std::uint64_t mass = in.get_varint();
        if (mass > std::uint64_t{1} << kMassBits) throw FormatError("a cell's probability is above one");
        tree.cell_mass.push_back(static_cast<std::uint32_t>(mass));
    }
    in.expect_end();
    find_distributions(tree);
    return tree;
}

}  // namespace treefarm
