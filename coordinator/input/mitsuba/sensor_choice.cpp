// SPDX-License-Identifier: Apache-2.0
#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/sensor.h"

namespace treefarm::mitsuba {
namespace {

std::string id_of(const Child& sensor) {
    const std::string* id = sensor.object->find("id");
    return id ? *id : "";
}

/// List "0 (cam0), 1, 2 (side)".
std::string list_of(const std::vector<Child>& sensors) {
    std::string text;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        text += (i > 0 ? ", " : "") + std::to_string(i);
        if (const std::string id = id_of(sensors[i]); !id.empty()) text += " (" + in_quotes(id) + ")";
    }
    return text;
}

}  // namespace

const XmlElement* choose_sensor(Properties& scene, const std::string& wanted, Diagnostics& diagnostics) {
    const std::vector<Child> sensors = scene.children("sensor");
    if (sensors.empty() && wanted.empty()) {
        const char* const what = "the scene has no sensor";
        const std::string instead = "a camera that looks at all of it along z is added, as in Mitsuba 0.6 and 2";
        if (scene.element().version < 3)
            diagnostics.warn(scene.where(), std::string(what) + ": " + instead);
        else
            diagnostics.attempt(
                [&] { diagnostics.unsupported(scene.where(), what, "add <sensor type=\"perspective\">", instead); });
        return nullptr;
    }
    if (!wanted.empty()) {
        for (const Child& sensor : sensors)
            if (id_of(sensor) == wanted) return sensor.object;
        if (const auto number = parse_unsigned(wanted); number && *number < sensors.size())
            return sensors[*number].object;
        throw InputError(scene.where(), "the scene has no sensor " + in_quotes(wanted),
                         sensors.empty() ? "leave --sensor away" : "choose one by number or id: " + list_of(sensors));
    }
    const bool takes_last = scene.element().version < 2;
    const Child& chosen = takes_last ? sensors.back() : sensors.front();
    if (sensors.size() > 1)
        diagnostics.note(chosen.object->where, "the " + std::string(takes_last ? "last" : "first") + " of " +
                                                   std::to_string(sensors.size()) +
                                                   " sensors is used; --sensor chooses another: " + list_of(sensors));
    return chosen.object;
}

}  // namespace treefarm::mitsuba
