// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>

#include "common/config/effects/light.h"
#include "common/config/effects/materials.h"
#include "common/config/effects/row.h"
#include "common/config/effects/shapes.h"
#include "common/config/effects/transport.h"

namespace treefarm {

/// All effects that the program knows; those that it never simulates come last. Modules below `plan` see names and
/// texts; finders and removers are instantiated in `plan` alone.
inline constexpr auto kEffectRows =
    std::tuple_cat(kLightEffects, kMaterialEffects, kShapeEffects, kCameraEffects, kTransportEffects, kNeverEffects);
inline constexpr std::size_t kEffectCount = std::tuple_size_v<decltype(kEffectRows)>;

/// Calls f(row) for every row, in the table's order.
template <class F>
constexpr void for_each_effect(F&& f) {
    std::apply([&](const auto&... row) { (f(row), ...); }, kEffectRows);
}

/// Index of the first row for which a predicate holds; kEffectCount if there is none.
template <class Test>
constexpr std::size_t find_effect(Test test) {
    std::size_t found = kEffectCount, index = 0;
    for_each_effect([&](const auto& row) {
        if (test(row)) found = index;
        ++index;
    });
    return found;
}

/// Whether a kind of a family may declare this effect as its own.
constexpr bool is_effect_of(EffectFamily family, std::string_view name) {
    return find_effect([&](const auto& row) { return row.family == family && name == row.text.name; }) < kEffectCount;
}

/// Index of an effect, from its name at compile time, where an unknown name is an error.
class EffectId {
  public:
    consteval EffectId(const char* name) : index_(index_of(name)) {}
    constexpr std::size_t index() const { return index_; }

  private:
    static consteval std::size_t index_of(std::string_view name) {
        const std::size_t index = find_effect([&](const auto& row) { return name == row.text.name; });
        if (index == kEffectCount) throw "no effect has this name";
        return index;
    }
    std::size_t index_;
};

/// First rule of the table that is violated, or nullptr.
consteval const char* fault_of_effects() {
    std::array<std::string_view, kEffectCount> names;
    std::array<bool, kEffectCount> with_switch{}, step_taken{};
    std::size_t count = 0, switches = 0;
    const char* fault = nullptr;
    for_each_effect([&](const auto& row) {
        for (std::size_t i = 0; i < count; ++i)
            if (names[i] == row.text.name) fault = "two rows have one name";
        with_switch[count] = kHasSwitch<decltype(row.off)>;
        names[count++] = row.text.name;
    });
    for_each_effect([&](const auto& row) {
        if constexpr (requires { row.off.step; }) {
            ++switches;
            const auto step = static_cast<std::size_t>(row.off.step);
            if (step >= kEffectCount || step_taken[step]) fault = "two switches have one step";
            if (step < kEffectCount) step_taken[step] = true;
        }
        if constexpr (requires { row.off.whole; }) {
            bool found = false;
            for (std::size_t i = 0; i < kEffectCount; ++i)
                found = found || (names[i] == row.off.whole && with_switch[i]);
            if (!found) fault = "a part is of an effect that has no switch";
        }
    });
    for (std::size_t step = 1; step <= switches; ++step)
        if (!step_taken[step]) fault = "steps leave one out";
    return fault;
}
static_assert(fault_of_effects() == nullptr);

}  // namespace treefarm
