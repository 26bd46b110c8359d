// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "worker/lights/discrete_table.h"
#include "worker/lights/environment_map.h"

namespace treefarm::test {

/// Choice of an environment map's parts.
struct MapParts {
    /// By power with a minimum (as in Emitters); or as if learned: from half to twice as often.
    explicit MapParts(const EnvironmentMap& map, bool learned = false) {
        std::vector<double> weights;
        for (int part = 0; part < map.part_count(); ++part)
            if (const double weight = map.part_weight(part); weight > 0)
                weights.push_back(std::max(weight, 1e-4) * (learned ? std::exp2(part % 3 - 1) : 1.0));
            else
                weights.push_back(0.0);
        table = DiscreteTable(weights);
        for (std::uint32_t part = 0; part < weights.size(); ++part)
            choice[part] = table.probability(part);
    }
    EnvironmentMap::Sample sample(const EnvironmentMap& map, const Draw& random) const {
        return map.sample(static_cast<int>(table.pick(random[0])), random);
    }
    DiscreteTable table;
    EnvironmentMap::PartChoice choice{};
};

}  // namespace treefarm::test
