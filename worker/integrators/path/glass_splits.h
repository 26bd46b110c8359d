// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "common/plan/policy.h"
#include "worker/geometry/ray.h"
#include "worker/integrators/path/path_state.h"

namespace treefarm {

/// Smooth glass sends a ray two ways. Where the camera sees it, a path need not toss: it takes the likelier way, and
/// the other one, of probability p, is followed, too, with probability min(1, 4 p), weighed accordingly, which adds to
/// the same sample. So what is seen through glass is not made noisy by what it mirrors, a mirror image is a quarter as
/// noisy or less, and a faint one does not cost a whole path.
class GlassSplits {
  public:
    GlassSplits() { branches_.reserve(kDrawBatch); }

    std::uint32_t size() const { return static_cast<std::uint32_t>(branches_.size()); }
    void clear() { branches_.clear(); }

    /// Chance with which a way of this probability is followed, never so small that its weight overflows, or that 24
    /// random bits do not tell.
    static float chance(float probability) {
        return std::clamp(kPolicy.walk.split_often * probability, kPolicy.walk.split_least, 1.0f);
    }

    /// Splits a path at the first surface, which has drawn path.scatter: if the other of two ways is open, the path
    /// takes the likelier with certainty, and the lesser may be followed, too.
    template <class Path>
    void split(Path& path, bool strict_normals) {
        const auto& surface = *path.surface;
        const BsdfSample other = surface.bsdf().other_branch(surface.wo(), path.scatter.local);
        if (!(other.pdf > 0.0f)) return;
        auto lesser = path.scatter;
        lesser.local = other.wi;
        lesser.world = surface.frame().to_world(other.wi);
        lesser.f_cos = other.f_cos;
        lesser.pdf = other.pdf;
        if (lesser.pdf > path.scatter.pdf) std::swap(lesser, path.scatter);
        path.scatter.effective_pdf = 1.0f;
        lesser.effective_pdf = chance(lesser.pdf);
        if (is_black(lesser.f_cos) || (strict_normals && dot(surface.ng(), lesser.world) * lesser.local.z <= 0.0f) ||
            !(to_unit(draw(path.key, path.vertex, Stream::glass_split)[0]) < lesser.effective_pdf))
            return;
        branches_.push_back({path.origin,
                             {offset_origin(path.hit, lesser.world), lesser.world},
                             lesser.f_cos * (1.0f / lesser.effective_pdf),
                             lesser.local.z < 0.0f ? surface.eta2() : 1.0f});
    }

    struct OtherBranch {
        std::uint16_t origin;  ///< the camera path that it is part of
        Ray ray;
        Rgb weight;    ///< f |cos| over the probability of being followed
        float spread;  ///< eta^2 where it is refracted
    };
    const OtherBranch& operator[](std::uint32_t i) const { return branches_[i]; }

  private:
    std::vector<OtherBranch> branches_;  ///< at most one of each camera path
};

}  // namespace treefarm
