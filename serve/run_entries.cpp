// SPDX-License-Identifier: Apache-2.0
#include "serve/run_entries.h"

#include <utility>

#include "common/runs/run_files.h"

namespace treefarm {

namespace {

/// Version of the files that an entry is made of.
std::string version_of(const ConfinedFolder& root, const std::string& run) {
    std::string text;
    for (const char* name : {kStatusFile, kSummaryFile, kPreviewFile}) {
        const auto version = root.version(joined_path(run, name));
        text += (version ? version->text() : "") + " ";
    }
    return text;
}

/// Whether a state changes with time alone.
bool depends_on_time(const nlohmann::ordered_json& entry) {
    return entry["state"] == "running" || entry["state"] == "silent";
}

}  // namespace

nlohmann::ordered_json RunEntries::of(const ConfinedFolder& root, const std::vector<std::string>& paths,
                                      const Here& here) {
    std::map<std::string, Kept> kept;
    nlohmann::ordered_json entries = nlohmann::ordered_json::array();
    for (const std::string& path : paths) {
        Kept now{version_of(root, path), here.now, {}};
        const auto before = kept_.find(path);
        if (before != kept_.end() && before->second.version == now.version && !depends_on_time(before->second.entry)) {
            now.entry = std::move(before->second.entry);
            auto& age = now.entry["age_seconds"];
            if (age.is_number()) age = age.get<double>() + static_cast<double>(here.now - before->second.now);
        } else {
            now.entry = run_entry(root, path, here);
        }
        entries.push_back(now.entry);
        kept.emplace(path, std::move(now));
    }
    kept_ = std::move(kept);
    return entries;
}

}  // namespace treefarm
