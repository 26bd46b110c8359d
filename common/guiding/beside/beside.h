// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/beside/sums_part.h"
#include "common/guiding/regions/cell_shape.h"
#include "common/guiding/regions/refinement.h"
#include "common/guiding/regions/region_sampler.h"

namespace treefarm {

/// Model of a guide `A` with another one, `B`, beside it. Regions and what they learn besides directions are A's.
/// B's fraction in a region of its own is 1 - bsdf_fraction: what it calls the BSDF is the mixture of BSDF and A.
template <class A, class B>
struct BesideModel : A::Model {
    typename B::Model beside;

    bool operator==(const BesideModel&) const = default;
};

/// Sampler of A with B beside it. B's distributions, and its cells, follow A's in number: `pdf(first() + d, code)` is
/// the density of B's distribution d. sample() and radiance() are A's.
template <class A, class B>
class BesideSampler : public A::Sampler {
  public:
    using Other = typename B::Sampler;

    explicit BesideSampler(const BesideModel<A, B>& model)
        : A::Sampler(model),
          beside_(model.beside),
          first_(A::Sampler::distribution_count()),
          first_cell_(A::Sampler::cell_count()),
          bytes_(A::Sampler::bytes() + beside_.bytes()) {
        const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        append(this->quantum_exponent_, model.beside.quantum_exponent);
        append(this->bsdf_fraction_, model.beside.bsdf_fraction);
    }

    const Other& beside() const { return beside_; }
    /// B's first distribution.
    std::uint32_t first() const { return first_; }

    float pdf(std::uint32_t distribution, std::uint32_t code) const {
        return distribution < first_ ? A::Sampler::pdf(distribution, code) : beside_.pdf(distribution - first_, code);
    }
    std::size_t bytes() const { return bytes_; }

    // Cells of records, for CellAccumulator.
    std::uint32_t cell_count() const { return first_cell_ + beside_.cell_count(); }
    std::uint32_t cell(std::uint32_t distribution, std::uint32_t code) const {
        return distribution < first_ ? A::Sampler::cell(distribution, code)
                                     : first_cell_ + beside_.cell(distribution - first_, code);
    }
    std::uint32_t cell_side(std::uint32_t distribution, std::uint32_t cell) const {
        return distribution < first_ ? A::Sampler::cell_side(distribution, cell)
                                     : beside_.cell_side(distribution - first_, cell - first_cell_);
    }
    void prefetch_pdf(std::uint32_t distribution, std::uint32_t code) const {
        if (distribution < first_)
            A::Sampler::prefetch_pdf(distribution, code);
        else
            beside_.prefetch_pdf(distribution - first_, code);
    }
    void prefetch_pdf_cell(std::uint32_t distribution, std::uint32_t code) const {
        if (distribution < first_)
            A::Sampler::prefetch_pdf_cell(distribution, code);
        else
            beside_.prefetch_pdf_cell(distribution - first_, code);
    }

  private:
    Other beside_;
    std::uint32_t first_, first_cell_;
    std::size_t bytes_;
};

/// Learner of both guides, each from its part of the sums.
template <class A, class B>
class BesideLearner {
  public:
    using Model = BesideModel<A, B>;

    Model learn(const Model& model, const CellSums& sums, const RefineSettings& settings, bool learn_mixture,
                RefineReport& report) {
        const SumsShape of_a = cell_shape<A>(model, learn_mixture), of_b = cell_shape<B>(model.beside, learn_mixture);
        if (sums.cells().size() != std::size_t{of_a.cells} + of_b.cells)
            throw RunError("the sums to learn from belong to another model");
        const std::uint32_t first = of_a.regions + of_a.views;
        RefineReport beside;
        Model next;
        static_cast<typename A::Model&>(next) =
            first_.learn(model, sums_part(sums, of_a, 0, 0), settings, learn_mixture, report);
        next.beside =
            beside_.learn(model.beside, sums_part(sums, of_b, first, of_a.cells), settings, learn_mixture, beside);
        next.beside.pass = next.pass;
        report.spatial_depth_capped += beside.spatial_depth_capped;
        report.directional_depth_capped += beside.directional_depth_capped;
        report.memory_capped += beside.memory_capped;
        return next;
    }

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(first_, beside_);
    }

  private:
    typename A::Learner first_;
    typename B::Learner beside_;
};

/// Two guides as one (guides.h): a vertex may sample the BSDF, the techniques of A, and the distribution of B's region
/// (worker/guides/beside_walk.h). Its fraction is learned as those of A are, from exact sums. B is a guide whose
/// distributions depend on the region alone; A may be two guides itself. Cells of both learn sums, not means.
template <class A, class B>
struct Beside {
    using Model = BesideModel<A, B>;
    using Sampler = BesideSampler<A, B>;
    using Learner = BesideLearner<A, B>;
    static_assert(!counts_visits<typename A::Sampler>() && !counts_visits<typename B::Sampler>());

    static constexpr std::uint32_t kMagic = A::kMagic ^ (B::kMagic << 8 | B::kMagic >> 24);
    static constexpr std::uint8_t kVersion = 1;
    static constexpr bool kGrows = A::kGrows || B::kGrows;
    static constexpr int kKernels = 3;
    static constexpr bool kPlainKernels = false;
    static constexpr SamplerCost kCost = {A::kCost.region, std::max(A::kCost.view, B::kCost.region),
                                          std::max(A::kCost.cell, B::kCost.cell)};

    static Model first(const Box3& bounds, const FirstModel& settings) {
        FirstModel beside = settings;
        beside.with_lights = beside.with_views = false;
        Model model;
        static_cast<typename A::Model&>(model) = A::first(bounds, settings);
        model.beside = B::first(bounds, beside);
        return model;
    }
    static Bytes encode(const Model& model) {
        ByteWriter out;
        out.put_array(std::span<const std::uint8_t>(A::encode(model)));
        out.put_bytes(B::encode(model.beside));
        return pack_model(kMagic, kVersion, out.take());
    }
    static Model decode(std::span<const std::uint8_t> bytes) {
        const Bytes raw = unpack_model(kMagic, kVersion, bytes);
        ByteReader in(raw);
        Model model;
        static_cast<typename A::Model&>(model) = A::decode(in.get_array<std::uint8_t>());
        model.beside = B::decode(in.get_rest());
        return model;
    }
    /// Size of both; the further distributions, B's, count as views.
    static ModelFigures figures(const Model& model) {
        ModelFigures figures = A::figures(model);
        const ModelFigures beside = B::figures(model.beside);
        figures.views += beside.regions + beside.views;
        figures.cells += beside.cells;
        return figures;
    }
};

}  // namespace treefarm
