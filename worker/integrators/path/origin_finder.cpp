// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/path/origin_finder.h"

#include <algorithm>

namespace treefarm {

void OriginFinder::PassedSurfaces::pass(const SurfacePassage& surface) {
    if (!surface.delta && !scattered) {  // surfaces that the camera sees by mirrors or glass are no random event
        last = PathClass::diffuse;
        scattered = true;
    }
    last = std::max(last, surface.path_class);
}

void OriginFinder::camera(const Ray& ray) {
    passed_ = {};
    view_ = ray.direction;
}

void OriginFinder::arrive(int depth, const Hit* hit) {
    depth_ = depth;
    left_scene_ = !hit;
    if (depth == 1 && hit) first_normal_ = hit->ng;
}

void OriginFinder::emission(const Rgb&, float, float, const Rgb& contribution) {
    found(left_scene_ ? LightFound::sky_met : LightFound::met, passed_, depth_, contribution);
}

void OriginFinder::scatter(const SurfacePassage& passage, const ScatterSample&, const Rgb&) {
    passed_.pass(passage);
}

void OriginFinder::next_event(const SurfacePassage& passage, const SampledLight& light, float, float,
                              const Rgb& contribution) {
    PassedSurfaces passed = passed_;
    passed.pass(passage);
    found(light.from_environment ? LightFound::sky_sampled : LightFound::sampled, passed, depth_ + 1, contribution);
}

void OriginFinder::other_branch(const Ray& ray, const Rgb&) {
    const bool through = dot(first_normal_, ray.direction) * dot(first_normal_, view_) > 0.0f;
    passed_ = {};
    passed_.pass({through ? PathClass::smooth_glass : PathClass::mirror, true});
}

void OriginFinder::split(std::uint32_t paths, const Rgb&) {
    waiting_.insert(waiting_.end(), paths - 1, passed_);
}

void OriginFinder::split_path(const SplitPath&) {
    passed_ = taken_ < waiting_.size() ? waiting_[taken_++] : PassedSurfaces();
}

void OriginFinder::found(LightFound how, const PassedSurfaces& passed, int vertices, const Rgb& contribution) {
    const float light = luminance(contribution);
    if (!(light > largest_)) return;
    largest_ = light;
    origin_ = {how, passed.last, static_cast<std::uint8_t>(std::min(vertices, 255))};
}

}  // namespace treefarm
