// SPDX-License-Identifier: Apache-2.0
#include "report/provenance.h"

#include <spdlog/fmt/fmt.h>

#include <set>

#include "common/runs/run_json.h"
#include "report/study_results.h"

namespace treefarm {

namespace {

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
    const RunJson json = read_run_json(folder / kSummaryFile);
    Provenance made{text_in(object_of(json, "build"), "source"), text_in(json, "host"), text_in(json, "processor"),
                    text_in(json, "started")};
    for (const RunJson& worker : array_of(object_of(json, "farm"), "workers")) {
        ++made.workers;
        made.threads += static_cast<int>(number_in(worker, "threads"));
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
