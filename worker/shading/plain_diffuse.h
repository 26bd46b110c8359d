// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/material.h"
#include "worker/shading/diffuse.h"

namespace treefarm {

/// BSDF of scenes in which every surface is black or diffuse with constant reflectance; used by the cheapest kernel. wo
/// may be on either side.
struct PlainDiffuse {
    Rgb reflectance{0.0f};
    bool twosided = false;

    /// Whether any light that leaves along wo may be reflected; false: nothing needs to be sampled.
    bool reflects(const Vec3& wo) const { return !is_black(reflectance) && (wo.z > 0.0f || (twosided && wo.z < 0.0f)); }

    BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        const bool mirrored = twosided && wo.z < 0.0f;
        if (!(mirrored || wo.z > 0.0f)) return {};
        return DiffuseBsdf{reflectance}.value(wo, on_side(wi, mirrored));
    }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        if (!reflects(wo)) return {};
        BsdfSample s = DiffuseBsdf{reflectance}.sample(wo, random);
        s.wi = on_side(s.wi, wo.z < 0.0f);
        return s;
    }

  private:
    static Vec3 on_side(const Vec3& w, bool mirrored) { return mirrored ? Vec3(w.x, w.y, -w.z) : w; }
};

}  // namespace treefarm
