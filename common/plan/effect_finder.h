// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>

#include "common/plan/effects.h"
#include "common/scene/model/material_traits.h"

namespace treefarm {

Effect effect_off(const std::string& reason);
Effect effect_on(const std::string& reason, std::uint64_t bytes = 0);

/// "1 disk", "2 disks", "2 meshes".
std::string plural(std::size_t count, const std::string& what);

/// Looks in a scene and its job for what calls for each effect. The scene and the job must outlive it.
class EffectFinder {
  public:
    EffectFinder(const Scene& scene, const Resolved& job);

    /// State, reason, place and bytes of an effect of effect_table(). Throws std::out_of_range for another name.
    Effect find(const std::string& name) const { return finders_.at(name)(); }

  private:
    using Finder = std::function<Effect()>;

    void add_light();
    void add_materials();
    void add_textures();
    void add_shapes();
    void add_transport();

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

    /// On if a material that is in use has a trait.
    template <class Test>
    Finder material_finder(const std::string& what, Test test) const;
    template <class Test>
    Finder texture_finder(const std::string& what, Test test) const;

    /// With tables and images.
    std::uint64_t emitter_bytes(const std::function<bool(const Emitter&)>& test) const;

    const Scene& scene_;
    const Resolved& job_;
    const std::vector<bool> used_;         ///< per material
    std::vector<bool> used_directly_;      ///< per material: a shape's own
    std::vector<bool> texture_in_use_;     ///< per texture
    std::vector<bool> image_of_textures_;  ///< per image
    std::map<std::string, Finder> finders_;
};

}  // namespace treefarm
