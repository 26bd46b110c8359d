// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/base/error.h"
#include "worker/lights/environment_map.h"
#include "worker/lights/light_bounds.h"

namespace treefarm {

/// The scene's environment map, if it has one; its parts are chosen individually (contract: environments.h).
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
    LightBounds bounds(int part) const {
        const double mean = map_->mean_luminance() * map_->part_weight(part);
        return LightBounds::from_infinity(map_->part_cone(part), 4.0 * double(kPi) * mean);
    }
    void choose(int part, float probability) { parts_[static_cast<std::size_t>(part)] = probability; }

    bool shines() const { return static_cast<bool>(map_); }
    Rgb radiance(const Vec3& direction) const { return map_->radiance(direction); }
    Sample sample(int part, const Draw& random) const { return map_->sample(part, random); }
    float pdf(const Vec3& direction, const auto& probabilities) const {
        return probabilities.by_power() ? map_->pdf(direction, parts_) : pdf(map_->towards(direction), probabilities);
    }
    float pdf(const Sample& drawn, const auto& probabilities) const {
        if (probabilities.by_power()) return map_->pdf(drawn, parts_);
        if (map_->black()) return 0.0f;
        EnvironmentMap::PartChoice choice{};
        map_->for_each_part(drawn.footprint,
                            [&](int part) { choice[static_cast<std::size_t>(part)] = probabilities(part); });
        return map_->pdf(drawn, choice);
    }

    /// The map, for drawing in batches.
    const EnvironmentMap& map() const { return *map_; }

  private:
    std::unique_ptr<EnvironmentMap> map_;
    EnvironmentMap::PartChoice parts_{};  ///< probability of each part by power
};

}  // namespace treefarm
