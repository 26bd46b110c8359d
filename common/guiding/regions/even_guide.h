// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/error.h"
#include "common/guiding/regions/region_learner.h"
#include "common/guiding/regions/strata.h"

namespace treefarm {

/// Learner of a guide of even regions. `Cells` (EvenGuide) learns directions, RegionLearner the rest.
template <class Cells>
class EvenLearner {
  public:
    using Model = typename Cells::Model;

    Model learn(const Model& model, const CellSums& sums, const RefineSettings& settings, bool learn_mixture,
                RefineReport& report) {
        const std::uint32_t regions = model.leaf_count();
        if (sums.cells().size() != std::size_t{regions} * kStrata || sums.counts().size() != regions)
            throw RunError("the sums to learn from belong to another model");
        Model next = model;
        advance_even_regions(next, report);
        for (std::uint32_t r = 0; r < regions; ++r) {
            const double recorded = cells_.learn(model, sums, settings, r, next);
            next.quantum_exponent[r] = learned_exponent(recorded, sums.counts()[r], model.quantum_exponent[r]);
        }
        regions_.learn(model, sums, settings, learn_mixture, report, next);
        return next;
    }

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(cells_, regions_);
    }

  private:
    Cells cells_;
    RegionLearner regions_;
};

/// Guide (guides.h) of even regions and strata of directions (strata.h). `Cells` is the guide's own part: the types
/// Model and Sampler, the constants kMagic and kCost; begin(), write() and read() for the model's values per cell; and
/// learn(), which sets these values in one region from a pass and returns the sum of the region's records.
template <class Cells>
struct EvenGuide {
    using Model = typename Cells::Model;
    using Sampler = typename Cells::Sampler;
    using Learner = EvenLearner<Cells>;

    static constexpr std::uint32_t kMagic = Cells::kMagic;
    static constexpr std::uint8_t kVersion = 1;
    static constexpr bool kGrows = false;
    static constexpr int kKernels = 3;
    static constexpr bool kPlainKernels = false;
    static constexpr SamplerCost kCost = Cells::kCost;

    static Model first(const Box3& bounds, const FirstModel& settings) {
        Model model;
        const std::uint32_t regions = begin_even_regions(model, bounds, settings);
        Cells::begin(model, std::size_t{regions} * kStrata);
        return model;
    }

    static Bytes encode(const Model& model) {
        ByteWriter out;
        write_regions(out, model);
        write_optional(out, model);
        Cells::write(out, model);
        return pack_model(kMagic, kVersion, out.take());
    }

    static Model decode(std::span<const std::uint8_t> bytes) {
        const Bytes raw = unpack_model(kMagic, kVersion, bytes);
        ByteReader in(raw);
        Model model;
        const std::uint32_t regions = read_even_regions(in, model);
        Cells::read(in, regions, model);
        in.expect_end();
        return model;
    }

    static ModelFigures figures(const Model& model) { return even_figures(model); }
};

}  // namespace treefarm
