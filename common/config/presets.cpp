// SPDX-License-Identifier: Apache-2.0
#include "common/config/presets.h"

#include <vector>

namespace treefarm {

std::span<const Setting> preset_settings(const std::string& preset) {
    static const std::vector<Setting> paper = {
        {"guiding.type", "ppg", {}},
        {"integrator.next_event", "never", {}},
        {"guiding.spatial_threshold", "12000", {}},
        {"guiding.directional_threshold", "0.01", {}},
        {"guiding.bsdf_fraction", "0.5", {}},
        {"guiding.spp_unit", "4", {}},
        {"guiding.combination", "last", {}},
        {"guiding.spatial_filter", "nearest", {}},
        {"guiding.directional_filter", "nearest", {}},
        {"guiding.target", "radiance", {}},
        {"guiding.roulette", "constant", {}},
        {"guiding.rule", "always", {}},
        {"guiding.splitting", "1", {}},
        {"guiding.splitting_rule", "always", {}},
        {"guiding.candidates", "1", {}},
        {"integrator.light_selection", "power", {}},
        {"integrator.split_glass", "false", {}},
    };
    // Additions that PPG's authors made to their program for the course "Path Guiding in Production" (SIGGRAPH 2019,
    // chapter 10). Its read-me names six parameters; the others are from the program. Next event is left to scene and
    // job.
    static const std::vector<Setting> improved = {
        {"guiding.type", "ppg", {}},
        {"integrator.mis", "power", {}},
        {"guiding.spatial_threshold", "4000", {}},
        {"guiding.directional_threshold", "0.01", {}},
        {"guiding.bsdf_fraction", "learned", {}},
        {"guiding.spp_unit", "1", {}},
        {"guiding.combination", "inverse_variance", {}},
        {"guiding.spatial_filter", "stochastic", {}},
        {"guiding.directional_filter", "box", {}},
        {"guiding.target", "radiance", {}},
        {"guiding.roulette", "constant", {}},
        {"guiding.rule", "always", {}},
        {"guiding.splitting", "1", {}},
        {"guiding.splitting_rule", "always", {}},
        {"guiding.candidates", "1", {}},
        {"integrator.light_selection", "power", {}},
        {"integrator.split_glass", "false", {}},
    };
    // The thesis' program: that of paper, with these settings in place of its own.
    static const std::vector<Setting> thesis = [] {
        std::vector<Setting> settings = paper;
        settings.insert(settings.end(), {{"guiding.type", "view", {}},
                                         {"integrator.next_event", "kickstart", {}},
                                         {"guiding.view_records", "radiance", {}},
                                         {"guiding.view_threshold", "4000", {}}});
        return settings;
    }();
    if (preset == "paper") return paper;
    if (preset == "improved") return improved;
    if (preset == "thesis") return thesis;
    return {};
}

}  // namespace treefarm
