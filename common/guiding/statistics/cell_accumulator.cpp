// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/statistics/cell_accumulator.h"

namespace treefarm {

RecordOrder order_by_distribution(std::span<const Record> records, std::size_t distributions) {
    std::vector<std::uint32_t> next(distributions + 1);
    for (const Record& record : records)
        ++next[record.distribution + 1];
    for (std::size_t d = 0; d < distributions; ++d)
        next[d + 1] += next[d];
    std::vector<std::uint32_t> order(records.size());
    for (std::uint32_t i = 0; i < records.size(); ++i)
        order[next[records[i].distribution]++] = i;
    return {std::move(order), std::move(next)};
}

}  // namespace treefarm
