// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/statistics/cell_sums.h"

#include <algorithm>
#include <iterator>

#include "common/evidence/evidence.h"
#include "common/math/saturating.h"

namespace treefarm {
namespace {

/// Cap of the contribution of one next-event sample; a larger one counts as this, which makes its emitter slightly less
/// likely.
constexpr double kMostLightUnits = 0x1p38;

}  // namespace

void UpdateCaps::add(const UpdateCaps& other) {
    capped_records += other.capped_records;
    saturated_cells += other.saturated_cells;
    outside_positions += other.outside_positions;
}

std::vector<BlockShape> cell_blocks(const SumsShape& shape) {
    const auto rows = [](bool exists, std::uint32_t count) { return exists ? count : 0; };
    constexpr auto kKind = BlockKind::sums;
    return {
        {"cells", "quanta", kKind, shape.cells},
        {"vertices", "vertices", kKind, shape.distributions(), 1, kMostClaim},
        {"mixture", "quanta", kKind, rows(shape.with_mixture, shape.distributions()), kMixtureBins},
        {"clusters of emitters", "2^-16 of the mean", kKind, rows(shape.with_lights, shape.regions), kLightClusters},
        {"visits", "records", kKind, rows(shape.with_visits, shape.cells), 1, kMostClaim},
        {"direct light", "next_event_unit()", kKind, rows(shape.with_next_event, shape.regions), kNextEventSums},
        {"caps", "contributions", kKind, 1, 2, kMostClaim}};
}

CellSums::CellSums(std::uint32_t pass, const SumsShape& shape, Blocks blocks)
    : pass_(pass), shape_(shape), blocks_(std::move(blocks)) {
    const std::vector<BlockShape> declared = cell_blocks(shape);
    for (std::size_t i = 0; i < declared.size(); ++i)
        if (blocks_.sums(i).shape() != declared[i]) throw RunError("the sums to learn from belong to another model");
}

UpdateCaps CellSums::caps_of(const Blocks& blocks) {
    const std::span<const std::uint64_t> counts = blocks.sums(kCaps).row(0);
    return {counts[0], blocks.saturated(), counts[1]};
}

void CellSums::add_caps(const UpdateCaps& caps) {
    const std::uint64_t counts[] = {caps.capped_records, caps.outside_positions};
    for (std::size_t i = 0; i < std::size(counts); ++i)
        blocks_.sums(kCaps).add(i, counts[i]);
}

void CellSums::add(const CellSums& other) {
    if (other.pass_ != pass_ || other.shape_ != shape_) throw RunError("sums of different trees cannot be added");
    blocks_.add(other.blocks_);
}

Bytes CellSums::encode() const {
    const Blocks* const owners[] = {&blocks_};
    return encode_evidence(pass_, owners);
}

std::uint64_t CellSums::merge_encoded(std::span<const std::uint8_t> update) {
    Blocks* const owners[] = {&blocks_};
    return merge_evidence(pass_, owners, update).front();
}

Record light_record(std::uint32_t region, int quantum_exponent, std::uint8_t cluster, float chosen, float reflected) {
    const auto x = static_cast<double>(reflected);
    const double units =
        x * x * static_cast<double>(chosen) * exact_power_of_two(-light_sum_exponent(quantum_exponent));
    // Halves round up: with 2^16 units per record no randomness is needed.
    return {region,
            0,
            std::uint32_t{1} << 31,
            0.0f,
            static_cast<float>(std::min(units, kMostLightUnits)),
            static_cast<std::uint8_t>(kLightBin + cluster)};
}

}  // namespace treefarm
