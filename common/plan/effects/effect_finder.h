// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "common/config/effects/table.h"
#include "common/plan/effects/effects.h"
#include "common/scene/uses/material_traits.h"

namespace treefarm {

Effect effect_off(const std::string& reason);
Effect effect_on(const std::string& reason, std::uint64_t bytes = 0);

/// Count with a noun: "1 disk", "2 disks", "2 meshes".
std::string plural(std::size_t count, const std::string& what);

/// Finds the effects that a scene and its job use. Rows of effects/table.h call its members; a member without arguments
/// has the name of the effect that it finds. The scene and the job must outlive it.
class EffectFinder {
  public:
    EffectFinder(const Scene& scene, const Resolved& job);

    /// State, reason, location and bytes of an effect.
    template <class Find, class Off>
    Effect find(const EffectRow<Find, Off>& row) const {
        return row.find(*this);
    }
    Effect find(EffectId effect) const;

    /// On if a material in use passes the test.
    template <class Test>
    Effect materials(const std::string& what, Test test) const {
        return called_by(scene_.materials, what,
                         [&](const Material& m, std::size_t i) { return used_[i] && test(own_traits(m)); });
    }
    /// State of an effect that kinds declare as their own: on if such a kind is in use.
    Effect kind(EffectFamily family, std::string_view effect) const;

    Effect next_event() const;
    Effect mis() const;
    Effect kickstart() const;
    Effect textured_area() const;
    Effect delta_lights() const;
    Effect environment() const;
    Effect textures() const;
    Effect masks() const;
    Effect triangles() const;
    Effect smooth_normals() const;
    Effect analytic_shapes() const;
    Effect instances() const;
    Effect lens() const;
    Effect pixel_filter() const;
    Effect guiding() const;
    Effect views() const;
    Effect recording() const;
    Effect light_subpaths() const;
    Effect light_image() const;
    Effect connections() const;
    Effect roulette() const;
    Effect depth_limit() const;
    Effect strict_normals() const;
    Effect hidden_emitters() const;
    /// State of effects that the program does not simulate: always off.
    Effect never() const { return effect_off("not simulated by this program"); }

  private:
    /// On if test(entry, index) holds for an entry of a list of the scene.
    template <class Range, class Test>
    static Effect called_by(const Range& range, const std::string& what, Test test) {
        std::size_t count = 0;
        Location first;
        for (std::size_t i = 0; i < range.size(); ++i)
            if (test(range[i], i) && count++ == 0) first = range[i].where;
        if (count == 0) return effect_off("nothing in the scene calls for it");
        Effect effect = effect_on(plural(count, what));
        effect.where = first;
        return effect;
    }
    template <class Test>
    Effect shapes(const std::string& what, Test test) const {
        return called_by(scene_.shapes, what, [&](const Shape& shape, std::size_t) { return test(shape); });
    }
    /// State for shapes other than meshes, with their memory in Embree.
    template <class Test>
    Effect objects(const std::string& what, Test test) const;

    template <class Kind>
    Effect emitter_kind() const;
    template <class Kind>
    Effect texture_kind() const;

    /// Bytes of emitters, tables and images included.
    std::uint64_t emitter_bytes(const std::function<bool(const Emitter&)>& test) const;

    const Scene& scene_;
    const Resolved& job_;
    const std::vector<bool> used_;      ///< per material
    std::vector<bool> used_directly_;   ///< per material: used by a shape directly
    std::vector<bool> texture_in_use_;  ///< per texture
};

}  // namespace treefarm
