// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

#include "worker/lights/constant.h"
#include "worker/lights/light_choice.h"
#include "worker/lights/map_light.h"

namespace treefarm {

/// Probabilities of a light's parts, for a density.
template <class Of>
struct PartProbabilities {
    const Of& of;
    std::uint32_t first;  ///< entry of part 0 in the table of emitters

    bool by_power() const { return of.by_power(); }
    float operator()(int part) const { return of(first + static_cast<std::uint32_t>(part)); }
};

/// Requirements of an environment light: its kind of emitter; the number of its parts, each with its power
/// (`from_infinity` times its mean radiance), its bounds and its probability by power; whether it shines; its radiance
/// against a direction; a sample of a part; and the density of a sampled direction over all of its parts, per
/// steradian.
template <class Light>
concept EnvironmentLight = requires(Light& light, const Light& given, const typename Light::Kind& kind,
                                    const TextureSet* textures, const Draw& random, const Vec3& direction,
                                    const typename Light::Sample& drawn,
                                    const PartProbabilities<EntryProbabilities>& probabilities) {
    light.add(kind, textures);
    light.choose(0, 0.0f);
    { given.part_count() } -> std::same_as<int>;
    { given.power(0, 0.0) } -> std::same_as<double>;
    { given.bounds(0) } -> std::same_as<LightBounds>;
    { given.shines() } -> std::same_as<bool>;
    { given.radiance(direction) } -> std::same_as<Rgb>;
    { given.sample(0, random) } -> std::same_as<typename Light::Sample>;
    { drawn.direction } -> std::convertible_to<Vec3>;
    { given.pdf(direction, probabilities) } -> std::same_as<float>;
    { given.pdf(drawn, probabilities) } -> std::same_as<float>;
};

/// All environment lights. A new kind is a line at the end of `Lights`; without it an emitter of that kind does not
/// compile.
class Environments {
  public:
    using Lights = std::tuple<ConstantLight, MapLight>;

    template <class Kind>
    void add(const Kind& kind, const TextureSet* textures) {
        static_assert(kLightsOf<Kind> == 1, "an environment needs one light in Environments::Lights");
        std::apply([&](auto&... light) { (add_to(light, kind, textures), ...); }, lights_);
    }

    bool shines() const {
        return std::apply([](const auto&... light) { return (light.shines() || ...); }, lights_);
    }

    /// Calls f(light, part) for each part of each light, in the order in which choose() assigns probabilities.
    template <class F>
    void for_each_part(F&& f) const {
        const auto each = [&](const auto& light) {
            for (int part = 0; part < light.part_count(); ++part)
                f(light, part);
        };
        std::apply([&](const auto&... light) { (each(light), ...); }, lights_);
    }
    /// Sets each part's probability by power, `probability(entry)`, for entries from `first` on.
    template <class F>
    void choose(std::uint32_t first, F&& probability) {
        std::size_t number = 0;
        const auto each = [&](auto& light) {
            first_[number++] = first;
            for (int part = 0; part < light.part_count(); ++part)
                light.choose(part, probability(first++));
        };
        std::apply([&](auto&... light) { (each(light), ...); }, lights_);
        map_parts_ = static_cast<std::uint32_t>(map().part_count());
    }

    /// Radiance from infinity, arriving against the unit `direction`.
    Rgb radiance(const Vec3& direction) const {
        return sum_of([&](const auto& light) { return light.radiance(direction); });
    }
    /// Radiance from infinity, with the light of type `Light` evaluated by `of_light`.
    template <class Light, class F>
    Rgb radiance_with(const Vec3& direction, F&& of_light) const {
        return sum_of([&]<class Other>(const Other& light) {
            if constexpr (std::is_same_v<Other, Light>)
                return of_light(light);
            else
                return light.radiance(direction);
        });
    }

    /// Density of sample() for a direction.
    float pdf(const Vec3& direction, const auto& probabilities) const {
        return density<void>(direction, direction, probabilities);
    }
    /// Density of sample() for a sample drawn by the light of type `Light`.
    template <class Light>
    float pdf_of(const typename Light::Sample& drawn, const auto& probabilities) const {
        return density<Light>(drawn.direction, drawn, probabilities);
    }

    /// Calls f.operator()<Light>(sample) with a sample of the part with this entry.
    template <class F>
    void sample(std::uint32_t entry, const Draw& random, F&& f) const {
        std::size_t number = 0;
        const auto each = [&]<class Light>(const Light& light) {
            const std::uint32_t part = entry - first_[number++];  // beyond all parts if the entry precedes them
            if (part < static_cast<std::uint32_t>(light.part_count()))
                f.template operator()<Light>(light.sample(static_cast<int>(part), random));
        };
        std::apply([&](const auto&... light) { (each(light), ...); }, lights_);
    }

    const MapLight& map() const { return std::get<MapLight>(lights_); }
    /// Part of the map with this entry; beyond its parts if it has none.
    std::uint32_t map_part(std::uint32_t entry) const { return entry - first_[kMap]; }
    bool is_map(std::uint32_t entry) const { return map_part(entry) < map_parts_; }

  private:
    static constexpr std::size_t kCount = std::tuple_size_v<Lights>;
    static constexpr std::size_t kMap = 1;
    static_assert(std::is_same_v<std::tuple_element_t<kMap, Lights>, MapLight>);

    template <class Kind>
    static constexpr int kLightsOf = []<EnvironmentLight... Light>(std::type_identity<std::tuple<Light...>>) {
        return (int(std::is_same_v<typename Light::Kind, Kind>) + ...);
    }
    (std::type_identity<Lights>());

    template <class Light, class Kind>
    static void add_to(Light& light, const Kind& kind, const TextureSet* textures) {
        if constexpr (std::is_same_v<typename Light::Kind, Kind>) light.add(kind, textures);
    }

    /// Sum over lights, in their order; the first is evaluated even if it does not shine.
    template <class F>
    Rgb sum_of(F&& of_light) const {
        Rgb sum = of_light(std::get<0>(lights_));
        const auto more = [&](const auto& light) {
            if (light.shines()) sum += of_light(light);
        };
        [&]<std::size_t... kMore>(std::index_sequence<kMore...>) {
            (more(std::get<kMore + 1>(lights_)), ...);
        }
        (std::make_index_sequence<kCount - 1>());
        return sum;
    }

    /// Sum of densities, with the light of type `Light` evaluated at its own sample.
    template <class Light, class Drawn, class Of>
    float density(const Vec3& direction, const Drawn& drawn, const Of& probabilities) const {
        const auto of_light = [&]<class Other>(const Other& light, std::uint32_t first) {
            const PartProbabilities<Of> parts{probabilities, first};
            if constexpr (std::is_same_v<Other, Light>)
                return light.pdf(drawn, parts);
            else
                return light.pdf(direction, parts);
        };
        float sum = of_light(std::get<0>(lights_), first_[0]);
        const auto more = [&](const auto& light, std::uint32_t first) {
            if (light.shines()) sum += of_light(light, first);
        };
        [&]<std::size_t... kMore>(std::index_sequence<kMore...>) {
            (more(std::get<kMore + 1>(lights_), first_[kMore + 1]), ...);
        }
        (std::make_index_sequence<kCount - 1>());
        return sum;
    }

    Lights lights_;
    std::uint32_t map_parts_ = 0;
    std::array<std::uint32_t, kCount> first_{};  ///< entry of each light's first part
};

}  // namespace treefarm
