// SPDX-License-Identifier: Apache-2.0

#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "tests/oracle/oracle.h"

namespace treefarm::oracle {

void quadtrees(std::uint64_t count, std::vector<Row>& rows) {
    Row density{"quadtree: density of a cell",
                "relative to energy / area, of cells with 1e-4 of the energy (the largest takes what rounding leaves)",
                2e-4};
    Row table{"quadtree: density against its integer table", "relative", 1.2e-7};
    Row whole{"quadtree: densities times areas over all cells, minus 1", "absolute", 1e-6};
    Row sums{"sum of rounded records, 2^-20 to 2^20 of the mean", "in standard errors of the rounding", 5.0};
    Inputs in(7);
    SdTree tree;
    for (std::uint64_t i = 0; i < count / 4096 + 8; ++i) {
        if (i % 8 == 0) tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
        CellSums energy(tree.pass, 1, tree.cell_count());
        const SdTreeSampler guide(tree);
        // A few narrow lobes over a faint background.
        for (std::uint32_t c = 0; c < tree.cell_count(); ++c)
            energy.add_quanta(c, static_cast<std::uint64_t>(in.scale(1.0f, 1e6f)));
        for (int lobe = 0; lobe < 3; ++lobe)
            energy.add_quanta(guide.cell(0, in.bits()), static_cast<std::uint64_t>(in.scale(1e6f, 1e17f)));
        energy.add_count(0, 1000);
        RefineReport report;
        const SdTree next = refine(tree, energy, {.spatial_threshold = 1e18}, report);
        const SdTreeSampler refined(next);
        Quad total = 0, sum = 0;
        for (const std::uint64_t e : energy.cells())
            total += Quad(e);
        std::uint64_t begin = 0;
        for (std::uint32_t c = 0; c < next.cell_count(); ++c) {
            const auto code = static_cast<std::uint32_t>(begin);
            const std::uint64_t size = std::uint64_t{1} << (2 * (kDirectionBits - next.cell_depth[c]));
            const Quad area = 4 * M_PIq * Quad(size) / Quad(0x1p32);
            const float ours = refined.pdf(0, code);
            if (next.cell_mass[c] > 0) table.see(relative(ours, Quad(next.cell_mass[c]) / Quad(0x1p30) / area), i, c);
            sum += Quad(ours) * area;
            // What the old cells under (or above) it held.
            const std::uint32_t old = guide.cell(0, code);
            const std::uint64_t side = guide.cell_side(0, old);
            if (side * side >= size) {
                const Quad fraction = Quad(energy.cells()[old]) / total * Quad(size) / Quad(side * side);
                if (fraction > Quad(1e-4)) density.see(relative(ours, fraction / area), i, c);
            }
            begin += size;
        }
        whole.see(static_cast<double>(fabsq(sum - 1)), i);
        tree = next;
        tree.pass = static_cast<std::uint32_t>(i + 1);
        if (i % 8 != 0) continue;
        Quad exact = 0, ours = 0, variance = 0;
        for (int r = 0; r < 4096; ++r) {
            const float value = in.scale(0x1p-20f, 0x1p20f);
            bool capped = false;
            ours += Quad(quantise(value, 0, in.bits(), capped));
            exact += Quad(value);
            const Quad fraction = Quad(value) - floorq(Quad(value));
            variance += fraction * (1 - fraction);
        }
        sums.see(static_cast<double>(fabsq(ours - exact) / sqrtq(variance)), i);
    }
    rows.insert(rows.end(), {density, table, whole, sums});
}

std::vector<Row> all(std::uint64_t count) {
    std::vector<Row> rows;
    microfacets(count, rows);
    boundaries(count, rows);
    directions(count, rows);
    lights(count, rows);
    quadtrees(count, rows);
    return rows;
}

}  // namespace treefarm::oracle
