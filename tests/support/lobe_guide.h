// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/guiding/beside/beside.h"
#include "common/guiding/regions/even_guide.h"
#include "common/guiding/sd_tree/sd_tree_guide.h"
#include "common/math/direction_map.h"
#include "common/math/frame.h"

namespace treefarm::test {

/// Toy guide: one lobe per region of an even grid, about the mean direction of the light recorded there. Its density is
/// a function of the direction as a vector, not of a cell: von Mises and Fisher's, of fixed width.
struct LobeModel : RegionModel {
    std::vector<Vec3> axis;  ///< per region, unit length

    bool operator==(const LobeModel&) const = default;
};

class LobeSampler : public RegionSampler {
  public:
    explicit LobeSampler(const LobeModel& model) : RegionSampler(model), axis_(model.axis) {}

    struct Sample {
        Vec3 direction;
        std::uint32_t code;
        float pdf;
    };
    Sample sample_direction(std::uint32_t region, const Draw& random) const {
        const double u = double(to_unit(random[2])), phi = 2 * M_PI * double(to_unit(random[3]));
        const double cosine =
            std::max(1 + std::log(u + (1 - u) * std::exp(-2 * kConcentration)) / kConcentration, -1.0);
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        const Vec3 local(float(sine * std::cos(phi)), float(sine * std::sin(phi)), float(cosine));
        const Vec3 direction = Frame(axis_[region]).to_world(local);
        return {direction, direction_to_code(direction), pdf(region, direction)};
    }
    float pdf(std::uint32_t region, const Vec3& direction) const {
        const double height = kConcentration / (2 * M_PI * (1 - std::exp(-2 * kConcentration)));
        return float(height * std::exp(kConcentration * (double(dot(axis_[region], direction)) - 1)));
    }

    // What reports ask every guide for.
    Sample sample(std::uint32_t region, const Draw& random) const { return sample_direction(region, random); }
    float pdf(std::uint32_t region, std::uint32_t code) const {
        const Vec2 square((static_cast<float>(compact_bits(code)) + 0.5f) * 0x1p-16f,
                          (static_cast<float>(compact_bits(code >> 1)) + 0.5f) * 0x1p-16f);
        return pdf(region, square_to_direction(square));
    }
    float radiance(std::uint32_t, std::uint32_t) const { return -1.0f; }

    // Cells of records, for CellAccumulator.
    std::uint32_t cell_count() const { return region_count() * kStrata; }
    static std::uint32_t cell(std::uint32_t region, std::uint32_t code) { return StrataSampler::cell(region, code); }
    static std::uint32_t cell_side(std::uint32_t = 0, std::uint32_t = 0) { return StrataSampler::cell_side(); }
    void prefetch_pdf(std::uint32_t, std::uint32_t) const {}
    void prefetch_pdf_cell(std::uint32_t, std::uint32_t) const {}

    std::size_t bytes() const { return region_bytes() + axis_.size() * sizeof(Vec3); }

  private:
    static constexpr double kConcentration = 20;
    std::vector<Vec3> axis_;
};

struct LobeCells {
    using Model = LobeModel;
    using Sampler = LobeSampler;

    static constexpr std::uint32_t kMagic = 0x424c4654;  ///< "TFLB"
    static constexpr SamplerCost kCost = {28, 0, 0};

    static void begin(LobeModel& model, std::size_t cells) { model.axis.assign(cells / kStrata, Vec3(0, 0, 1)); }
    static double learn(const LobeModel&, const CellSums& sums, const RefineSettings&, std::uint32_t region,
                        LobeModel& next) {
        double recorded = 0;
        std::array<double, 3> mean{};
        for (std::uint32_t s = 0; s < kStrata; ++s) {
            const auto energy = static_cast<double>(sums.cells()[region * kStrata + s]);
            const Vec2 middle((static_cast<float>(compact_bits(s)) + 0.5f) / 8,
                              (static_cast<float>(compact_bits(s >> 1)) + 0.5f) / 8);
            const Vec3 d = square_to_direction(middle);
            for (int axis = 0; axis < 3; ++axis)
                mean[static_cast<std::size_t>(axis)] += energy * double(d[axis]);
            recorded += energy;
        }
        const Vec3 axis(float(mean[0] / recorded), float(mean[1] / recorded), float(mean[2] / recorded));
        if (recorded > 0 && dot(axis, axis) > 1e-6f) next.axis[region] = normalize(axis);
        return recorded;
    }
    static void write(ByteWriter& out, const LobeModel& model) {
        for (const Vec3& axis : model.axis)
            for (int i = 0; i < 3; ++i)
                out.put(axis[i]);
    }
    static void read(ByteReader& in, std::uint32_t regions, LobeModel& model) {
        if (regions > in.remaining() / 12) throw FormatError("lobes are cut short");
        for (std::uint32_t r = 0; r < regions; ++r) {
            const float x = in.get<float>(), y = in.get<float>(), z = in.get<float>();
            model.axis.emplace_back(x, y, z);
            if (!(std::abs(dot(model.axis.back(), model.axis.back()) - 1.0f) < 1e-3f))
                throw FormatError("a lobe's axis is out of range");
        }
    }
    template <class Archive>
    void serialize(Archive&) {}
};
using LobeGuide = EvenGuide<LobeCells>;

/// The toy beside the tree: the one line that a further guide costs.
using TreeBesideLobes = Beside<SdTreeGuide, LobeGuide>;

}  // namespace treefarm::test
