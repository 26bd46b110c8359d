// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/base/error.h"
#include "worker/lights/environment_map.h"

namespace treefarm {

/// A scene's environment map, if it has one: each of its parts is chosen for itself (contract: environments.h).
class MapLight {
  public:
    using Kind = EnvironmentEmitter;
    using Sample = EnvironmentSample;

    /// Throws RunError if the image is missing, or there is a map already.
    void add(const EnvironmentEmitter& emitter, const TextureSet* textures) {
        if (map_) throw RunError("the scene has two environment maps");
        if (!textures || emitter.image < 0 || static_cast<std::size_t>(emitter.image) >= textures->images().size())
            throw RunError("the image of an environment map is missing");
        map_ = std::make_unique<EnvironmentMap>(emitter, textures->images()[static_cast<std::size_t>(emitter.image)]);
    }
    int part_count() const { return map_ ? map_->part_count() : 0; }
    double power(int part, double from_infinity) const {
        return from_infinity * map_->mean_radiance() * map_->part_weight(part);
    }
    void choose(int part, float probability) { parts_[static_cast<std::size_t>(part)] = probability; }

    bool shines() const { return static_cast<bool>(map_); }
    Rgb radiance(const Vec3& direction) const { return map_->radiance(direction); }
    Sample sample(int part, const Draw& random) const { return map_->sample(part, random); }
    /// `drawn`: a direction, or a sample of it.
    float pdf(const auto& drawn, const auto& factors) const { return map_->pdf(drawn, choice(factors)); }

    /// What draws many together asks.
    const EnvironmentMap& map() const { return *map_; }

  private:
    EnvironmentMap::PartChoice choice(const auto& factors) const {
        if (factors.even()) return parts_;
        EnvironmentMap::PartChoice choice = parts_;
        for (int part = 0; part < map_->part_count(); ++part)
            choice[static_cast<std::size_t>(part)] *= factors(part);
        return choice;
    }

    std::unique_ptr<EnvironmentMap> map_;
    EnvironmentMap::PartChoice parts_{};  ///< probability that each is chosen
};

}  // namespace treefarm
