// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "common/base/policy.h"
#include "worker/geometry/ray.h"
#include "worker/integrators/path/path_state.h"

namespace treefarm {

/// Splits at smooth glass, which has two branches. Where the camera sees it, a path always takes the likelier branch.
/// The other one, of probability p, is followed, too, with probability min(1, 4 p). It is weighted accordingly and
/// added to the same sample. The refracted image thus has no noise from the choice, a reflection has a quarter of
/// the noise or less, and a faint reflection does not cost a whole path.
class GlassSplits {
  public:
    GlassSplits() { branches_.reserve(kDrawBatch); }

    std::uint32_t size() const { return static_cast<std::uint32_t>(branches_.size()); }
    void clear() { branches_.clear(); }

    /// Probability with which a branch of this probability is followed, bounded below so that its weight does not
    /// overflow and 24 random bits resolve it.
    static float chance(float probability) {
        return std::clamp(tuned<float>("walk.split_often") * probability, 0x1p-12f, 1.0f);
    }

    /// Splits a path at its first surface, where path.scatter has been drawn: if the other branch is open, the path
    /// takes the likelier one with certainty, and the other one may also be followed.
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
        std::uint16_t origin;  ///< index of its camera path
        Ray ray;
        Rgb weight;    ///< f |cos| over the probability of following this branch
        float spread;  ///< eta^2 if refracted, else 1
    };
    const OtherBranch& operator[](std::uint32_t i) const { return branches_[i]; }

  private:
    std::vector<OtherBranch> branches_;  ///< at most one per camera path
};

}  // namespace treefarm
