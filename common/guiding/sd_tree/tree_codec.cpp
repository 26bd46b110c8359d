// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree/sd_tree.h"

namespace treefarm {
namespace {

constexpr std::uint8_t kVersion = 4;

/// Divides the list of view depths into T2s: a T2 is complete when its views cover the square.
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
    std::uint32_t next = 0;  // T2s are numbered in order of appearance
    for (std::uint32_t r = 0; r < tree.view_set.size(); ++r) {
        const std::uint32_t set = tree.view_set[r];
        const bool known = r != 0 && set == tree.view_set[r - 1];
        if (set != SdTree::kNoViews && !known && set != next++) throw FormatError("a region's views are out of order");
    }
    if (covered != 0 || tree.view_set.size() != regions || next != tree.view_set_count())
        throw FormatError("a tree's views do not match its regions");
}

/// Divides the list of cell depths into distributions: one is complete when its cells cover the square.
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

}  // namespace

Bytes encode_tree(const SdTree& tree) {
    ByteWriter out;
    write_regions(out, tree);
    write_views(out, tree);
    write_optional(out, tree);
    out.put_array(std::span<const std::uint8_t>(tree.cell_depth));
    for (const std::uint32_t mass : tree.cell_mass)
        out.put_varint(mass);
    return pack_model(kTreeMagic, kVersion, out.take());
}

SdTree decode_tree(std::span<const std::uint8_t> bytes) {
    const Bytes raw = unpack_model(kTreeMagic, kVersion, bytes);
    ByteReader in(raw);
    SdTree tree;
    const std::uint32_t regions = read_regions(in, tree);
    tree.view_depth = in.get_array<std::uint8_t>();
    if (tree.quantum_exponent.size() != regions + tree.view_depth.size())
        throw FormatError("a tree's regions do not match its nodes");
    if (tree.view_count() != 0) {
        tree.view_fraction = in.get_array<float>();
        for (std::uint32_t r = 0; r < regions; ++r)
            tree.view_set.push_back(static_cast<std::uint32_t>(in.get_varint()) - 1);
        find_views(tree, regions);
    }
    read_optional(in, tree, regions);
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
