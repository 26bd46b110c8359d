// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/flip/separable_filter.h"

#include <algorithm>
#include <array>

namespace treefarm {

namespace {

/// Weighted sum out[x] = sum over k of weights[k] rows[k][x], in blocks whose sums stay in registers.
void weighted_sum(const std::vector<const float*>& rows, const Kernel& weights, std::span<float> out) {
    constexpr std::size_t kBlock = 16;  // two registers of AVX2; GCC 12 keeps larger ones in memory
    std::size_t x = 0;
    for (; x + kBlock <= out.size(); x += kBlock) {
        std::array<float, kBlock> sum{};
        for (std::size_t k = 0; k < weights.size(); ++k)
            for (std::size_t i = 0; i < kBlock; ++i)
                sum[i] += weights[k] * rows[k][x + i];
        std::copy(sum.begin(), sum.end(), out.begin() + static_cast<std::ptrdiff_t>(x));
    }
    for (; x < out.size(); ++x) {
        float sum = 0.0f;
        for (std::size_t k = 0; k < weights.size(); ++k)
            sum += weights[k] * rows[k][x];
        out[x] = sum;
    }
}

/// Filter of rows along x.
class AcrossFilter {
  public:
    AcrossFilter(int width, const Kernel& kernel) : kernel_(kernel), rows_(kernel.size()) {
        padded_.resize(static_cast<std::size_t>(width) + kernel.size() - 1);
        for (std::size_t k = 0; k < kernel.size(); ++k)
            rows_[k] = padded_.data() + k;
    }

    void filter(std::span<const float> row, std::span<float> out) {
        const auto begin = padded_.begin() + static_cast<std::ptrdiff_t>(kernel_.size() / 2);
        std::fill(padded_.begin(), begin, row.front());
        std::fill(std::copy(row.begin(), row.end(), begin), padded_.end(), row.back());
        weighted_sum(rows_, kernel_, out);
    }

  private:
    const Kernel& kernel_;
    std::vector<float> padded_;
    std::vector<const float*> rows_;
};

}  // namespace

Plane filter_separable(const Plane& plane, const Kernel& across, const Kernel& down) {
    const int size = static_cast<int>(down.size()), radius = size / 2;
    AcrossFilter filter(plane.width, across);
    Plane window(plane.width, size);  // row y of the plane, filtered across, is row y % size
    Plane result(plane.width, plane.height);
    std::vector<const float*> rows(down.size());
    int filtered = 0;
    for (int y = 0; y < plane.height; ++y) {
        for (; filtered <= std::min(y + radius, plane.height - 1); ++filtered)
            filter.filter(plane.row(filtered), window.row(filtered % size));
        for (int k = 0; k < size; ++k)
            rows[static_cast<std::size_t>(k)] =
                window.row(std::clamp(y + k - radius, 0, plane.height - 1) % size).data();
        weighted_sum(rows, down, result.row(y));
    }
    return result;
}

}  // namespace treefarm
