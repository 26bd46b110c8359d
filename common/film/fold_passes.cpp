// SPDX-License-Identifier: Apache-2.0
#include "common/film/fold_passes.h"

#include <tuple>
#include <utility>

#include "common/base/parallel.h"

namespace treefarm {
namespace {

/// Least number of pixels per thread.
constexpr std::size_t kLeastFolded = 4096;

/// Cost of merging a pass into the one before it.
enum class Loss { none, other_tree, other_technique };

Loss loss_of(const PassResult& first, const PassResult& second) {
    if (second.new_technique) return Loss::other_technique;
    return second.same_tree && first.guided == second.guided ? Loss::none : Loss::other_tree;
}

std::vector<PassPart> parts_of(const PassResult& pass) {
    return pass.parts.empty() ? std::vector<PassPart>{{pass.spp, pass.spp_before}} : pass.parts;
}

void merge_into(PassResult& first, PassResult second) {
    std::vector<PassPart> parts = parts_of(first);
    for (const PassPart& part : parts_of(second))
        parts.push_back(part);
    first.parts = std::move(parts);
    first.spp += second.spp;
    first.guided = second.guided;
    first.stored.clear();
    in_parts(first.pixels.size(), kLeastFolded, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            first.pixels[p] = PixelEstimate::merge(first.pixels[p], second.pixels[p]);
    });
}

}  // namespace

std::size_t pair_to_fold(std::span<const PassResult> passes) {
    const auto price = [&](std::size_t k) {
        return std::tuple(loss_of(passes[k], passes[k + 1]), passes[k].spp + passes[k + 1].spp);
    };
    std::size_t best = 0;
    for (std::size_t k = 1; k + 2 < passes.size(); ++k)
        if (price(k) < price(best)) best = k;
    return best;
}

void fold_passes(std::vector<PassResult>& passes) {
    if (passes.size() <= kMostPassImages) return;
    const std::size_t first = pair_to_fold(passes);
    merge_into(passes[first], std::move(passes[first + 1]));
    passes.erase(passes.begin() + static_cast<std::ptrdiff_t>(first) + 1);
    // Noise is stored in the first of the passes that are alike, which may be an earlier one.
    for (std::size_t k = 0; k <= first; ++k)
        passes[k].noise = {};
}

}  // namespace treefarm
