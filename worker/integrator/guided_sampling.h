#pragma once

#include <array>

#include "common/guiding/guide.h"
#include "common/math/warp_batch.h"

namespace treefarm {

/// A sampled direction at a surface.
struct ScatterSample {
    Vec3 local;  ///< in the shading frame
    Vec3 world;
    Rgb f_cos;                 ///< f |cos|
    float pdf;                 ///< per steradian, of the whole mixture; delta: the probability of the lobe
    float bsdf_pdf;            ///< of the BSDF alone
    float guide_pdf;           ///< of the tree alone, where it guides
    std::uint32_t code;        ///< Z-order code of the direction, where the tree is used
    std::uint32_t conversion;  ///< its number among the batch's conversions
    bool guided;               ///< drawn from the tree
    bool delta;                ///< of a lobe without density, which the guide cannot find
};

/// Density of a mixture that samples the BSDF with the probability `bsdf_fraction`, the guide otherwise. The guide
/// stands in for smooth lobes only: the delta lobes of a BSDF that has both are sampled by the BSDF, at bsdf_fraction
/// times their probability (Mueller et al. 2017, as their program does it).
inline float mixed_pdf(float bsdf_fraction, float bsdf_pdf, float guide_pdf) {
    return bsdf_fraction * bsdf_pdf + (1.0f - bsdf_fraction) * guide_pdf;
}

/// Directions whose codes are wanted, collected over a batch of paths and converted together, by vector code.
class CodeBatch {
  public:
    void clear() { count_ = 0; }

    /// Returns the conversion's number.
    std::uint32_t add(const Vec3& direction) {
        from_.set(count_, direction);
        return count_++;
    }

    void convert() { direction_to_code_batch(from_, count_, codes_); }
    std::uint32_t operator[](std::size_t i) const { return codes_[i]; }

  private:
    std::uint32_t count_ = 0;
    DirectionBatch from_;
    alignas(64) std::array<std::uint32_t, kDrawBatch> codes_;
};

/// The same of places on the direction square whose directions are wanted.
class PlaceBatch {
  public:
    void clear() { count_ = 0; }

    std::uint32_t add(const Vec2& place) {
        x_[count_] = place.x;
        y_[count_] = place.y;
        return count_++;
    }

    void convert() { square_to_direction_batch(x_, y_, count_, directions_); }
    Vec3 operator[](std::size_t i) const { return directions_[i]; }

  private:
    std::uint32_t count_ = 0;
    alignas(64) std::array<float, kDrawBatch> x_, y_;
    DirectionBatch directions_;
};

}  // namespace treefarm
