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
        {"guiding.candidates", "1", {}},
        {"guiding.light_selection", "power", {}},
        {"integrator.split_glass", "false", {}},
    };
    // The thesis' program is that of paper but for these: they come later and win.
    static const std::vector<Setting> thesis = [] {
        std::vector<Setting> settings = paper;
        settings.insert(settings.end(), {{"guiding.type", "view", {}},
                                         {"integrator.next_event", "kickstart", {}},
                                         {"guiding.view_records", "radiance", {}},
                                         {"guiding.view_threshold", "4000", {}}});
        return settings;
    }();
    if (preset == "paper") return paper;
    if (preset == "thesis") return thesis;
    return {};
}

}  // namespace treefarm
