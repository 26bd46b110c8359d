// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/life_status.h"

#include <array>
#include <climits>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/base/text/printable.h"

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, kLifePhases> kNames = {"start", "scene", "gather", "pass", "combine", "write", "end"};

LifePhase phase_of(const std::string& name) {
    for (std::size_t k = 0; k < kNames.size(); ++k)
        if (name == kNames[k]) return static_cast<LifePhase>(k);
    throw std::invalid_argument("no phase");
}

}  // namespace

const char* life_phase_name(LifePhase phase) {
    return kNames[static_cast<std::size_t>(phase)];
}

namespace {

Json life_json(const LifeStatus& status) {
    Json workers = Json::array();
    for (const LifeWorker& worker : status.workers)
        workers.push_back({{"host", worker.host}, {"lost", worker.lost}});
    Json json = {{"attempt", status.attempt},   {"beat", status.beat},
                 {"progress", status.progress}, {"phase", life_phase_name(status.phase)},
                 {"pass", status.pass},         {"passes", status.passes},
                 {"renders", status.renders},   {"host", status.host},
                 {"pid", status.pid},           {"workers", workers}};
    if (status.code) json["code"] = *status.code;
    if (status.ended_by_launcher) json["ended_by_launcher"] = true;
    return json;
}

}  // namespace

std::string life_status_text(const LifeStatus& status) {
    return life_json(status).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string life_line(LifeStatus status) {
    std::string line = kLifeMark + life_json(status).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    if (line.size() <= PIPE_BUF || status.workers.empty()) return line;
    status.workers.clear();
    return life_line(std::move(status));
}

std::optional<LifeStatus> parse_life_status(const std::string& text) {
    try {
        const Json json = Json::parse(text);
        LifeStatus status;
        json.at("attempt").get_to(status.attempt);
        json.at("beat").get_to(status.beat);
        json.at("progress").get_to(status.progress);
        status.phase = phase_of(json.at("phase").get<std::string>());
        json.at("pass").get_to(status.pass);
        json.at("passes").get_to(status.passes);
        json.at("renders").get_to(status.renders);
        status.host = printable(json.at("host").get<std::string>());
        json.at("pid").get_to(status.pid);
        for (const Json& worker : json.at("workers"))
            status.workers.push_back({printable(worker.at("host").get<std::string>()), worker.at("lost").get<bool>()});
        if (json.contains("code")) status.code = json["code"].get<int>();
        status.ended_by_launcher = json.value("ended_by_launcher", false);
        return status;
    } catch (const std::exception&) {  // of another program, or damaged
        return std::nullopt;
    }
}

}  // namespace treefarm
