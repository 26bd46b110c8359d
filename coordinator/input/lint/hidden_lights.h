// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/input/check/finding.h"
#include "coordinator/input/lint/first_hit.h"

namespace treefarm::linting {

/// Emitters without extent whose light reaches what the camera sees by smooth glass or mirrors alone: paths from the
/// camera cannot find it, since a smooth surface leaves them one direction, and a point is never hit by chance. Judged
/// by a few hundred rays.
class HiddenLights {
  public:
    /// The arguments must outlive it.
    HiddenLights(const Scene& scene, const FirstHitSearch& search);

    /// Adds a finding if the emitter is such a light.
    void judge(const Emitter& emitter, std::vector<Finding>& findings);

  private:
    static constexpr int kColumns = 12, kRows = 8;  ///< of the camera's rays
    static constexpr int kLightRays = 96;           ///< of an emitter
    static constexpr int kMostSmooth = 8;           ///< smooth surfaces that a ray is followed over
    static constexpr double kStep = 1e-5;           ///< offset from a surface, over the scene's size
    static constexpr double kNear = 0.1;            ///< distance from a point that is seen, over the scene's size

    /// End of a ray at a surface that is neither smooth glass nor a mirror, just before it.
    struct End {
        Imath::V3d point;
        int passed = 0;  ///< smooth surfaces on the way
    };
    /// Obstacles on the straight way from a point to an emitter.
    enum class Way { open, glass, closed };

    bool is_smooth(std::size_t shape, bool& transmits) const;
    std::optional<End> follow(Imath::V3d origin, Imath::V3d direction) const;
    Way way(const Imath::V3d& p, const Emitter& emitter) const;
    bool comes_by_mirrors(const Emitter& emitter) const;
    void look();

    const Scene& scene_;
    const FirstHitSearch& search_;
    double size_ = 0;  ///< of the scene
    bool looked_ = false;
    std::vector<Imath::V3d> seen_;  ///< points that the camera sees, also in mirrors and through glass
};

}  // namespace treefarm::linting
