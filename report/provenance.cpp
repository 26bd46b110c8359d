// SPDX-License-Identifier: Apache-2.0
#include "report/provenance.h"

#include <spdlog/fmt/fmt.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "report/study_results.h"

namespace treefarm {

namespace {

using Json = nlohmann::json;

std::string text_at(const Json& json, const char* key) {
    const auto at = json.find(key);
    return at != json.end() && at->is_string() ? at->get<std::string>() : "";
}

std::string joined(const std::set<std::string>& texts, const char* before) {
    std::string all;
    for (const std::string& text : texts)
        if (!text.empty()) all += (all.empty() ? before : ", ") + text;
    return all;
}

std::string counted(const std::set<int>& numbers, const char* what) {
    if (numbers.empty() || *numbers.rbegin() == 0) return "";
    if (numbers.size() > 1) return fmt::format("{} to {} {}s", *numbers.begin(), *numbers.rbegin(), what);
    return fmt::format("{} {}{}", *numbers.begin(), what, *numbers.begin() == 1 ? "" : "s");
}

}  // namespace

Provenance read_provenance(const std::filesystem::path& folder) {
    std::ifstream file(folder / "summary.json", std::ios::binary);
    const Json json = Json::parse(file, nullptr, false);
    Provenance made;
    if (!json.is_object()) return made;
    if (json.contains("build") && json["build"].is_object()) made.source = text_at(json["build"], "source");
    made.host = text_at(json, "host");
    made.processor = text_at(json, "processor");
    made.started = text_at(json, "started");
    if (!json.contains("farm") || !json["farm"].is_object() || !json["farm"].contains("workers")) return made;
    for (const Json& worker : json["farm"]["workers"]) {
        ++made.workers;
        made.threads += worker.value("threads", 0);
    }
    return made;
}

std::string provenance_text(std::span<const CellResult> cells) {
    std::set<std::string> sources, hosts, processors, times;
    std::set<int> workers, threads;
    for (const CellResult& cell : cells) {
        sources.insert(cell.made.source);
        hosts.insert(cell.made.host);
        processors.insert(cell.made.processor);
        if (!cell.made.started.empty()) times.insert(cell.made.started);
        workers.insert(cell.made.workers);
        threads.insert(cell.passes.empty() ? cell.made.threads : cell.passes.back().threads);
    }
    std::string text = "Rendered" + joined(sources, " by treefarm ") + joined(hosts, " on ");
    const std::string kinds = joined(processors, "");
    if (!kinds.empty()) text += " (" + kinds + ")";
    if (!times.empty()) text += (times.size() == 1 ? " at " : " from ") + *times.begin();
    if (times.size() > 1) text += " to " + *times.rbegin();
    if (!times.empty()) text += " UTC";
    const std::string by = counted(workers, "worker"), with = counted(threads, "thread");
    if (!by.empty()) text += ", by " + by;
    if (!with.empty()) text += (by.empty() ? ", by " : " with ") + with + " in all";
    return text + ".";
}

}  // namespace treefarm
