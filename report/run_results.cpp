// SPDX-License-Identifier: Apache-2.0
#include "report/run_results.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "common/base/error.h"
#include "common/base/files/read_bytes.h"
#include "common/runs/run_json.h"

namespace treefarm {

namespace {

using Settings = std::map<std::string, std::string>;

/// A render with the data of its folder.
struct Run {
    CellResult cell;
    std::string scene_file;
    Settings settings;  ///< keys of job.toml without seed and image size
};

/// Settings of a job.toml in the form that this program writes: [section] lines, then key = value.
Settings read_settings(const std::filesystem::path& file) {
    Settings settings;
    std::istringstream in(read_text(file));
    std::string section;
    for (std::string line; std::getline(in, line);) {
        const std::size_t equals = line.find(" = ");
        if (line.starts_with('[') && line.ends_with(']')) section = line.substr(1, line.size() - 2) + ".";
        if (equals != std::string::npos) settings[section + line.substr(0, equals)] = line.substr(equals + 3);
    }
    return settings;
}

Run read_run(const std::filesystem::path& folder) {
    const Location where{folder.string()};
    try {
        const RunJson json = read_whole_run_json(folder / kSummaryFile);
        Run run;
        run.cell.folder = folder;
        run.cell.made = read_provenance(folder);
        run.cell.width = json.at("width");
        run.cell.height = json.at("height");
        run.scene_file = json.at("scene");
        double core_seconds = 0;
        for (const RunJson& pass : json.at("passes")) {
            PassRow& row = run.cell.passes.emplace_back(read_pass(pass));
            row.threads = run.cell.made.threads;
            row.core_seconds = core_seconds += row.core_seconds;
        }
        if (run.cell.passes.empty() || !(run.cell.passes.back().estimate > 0))
            throw InputError(where, "ended before its error was known", "leave it out, or render more samples");
        run.settings = read_settings(folder / kJobFile);
        if (const auto seed = run.settings.find("sampler.seed"); seed != run.settings.end())
            run.cell.seed = std::strtoull(seed->second.c_str(), nullptr, 10);
        std::erase_if(run.settings, [](const auto& setting) {
            return setting.first == "sampler.seed" || setting.first.starts_with("image.");
        });
        return run;
    } catch (const RunJson::exception& error) {
        throw InputError(where, std::string("what a render left is damaged: ") + error.what(),
                         "render it again, or leave it out");
    }
}

/// Keys in which runs differ.
std::set<std::string> differing_keys(const std::vector<Run>& runs) {
    std::set<std::string> keys;
    for (const Run& run : runs)
        for (const Run& other : runs) {
            if (other.scene_file != run.scene_file) continue;
            for (const auto& [key, value] : run.settings)
                if (const auto at = other.settings.find(key); at == other.settings.end() || at->second != value)
                    keys.insert(key);
        }
    return keys;
}

Settings chosen(const Settings& settings, const std::set<std::string>& keys) {
    Settings some;
    for (const auto& [key, value] : settings)
        if (keys.contains(key)) some[key] = value;
    return some;
}

std::string method_name(const Settings& settings) {
    std::string name;
    for (const auto& [key, value] : settings) {
        std::string plain = value;
        std::erase_if(plain, [](char c) { return c == '"' || c == '\''; });
        name += (name.empty() ? "" : ", ") + key.substr(key.find('.') + 1) + " = " + plain;
    }
    return name.empty() ? "render" : name;
}

/// Appends a scene or a method unless its name is there.
template <class Named>
void add_once(std::vector<Named>& list, Named one) {
    if (std::none_of(list.begin(), list.end(), [&](const Named& there) { return there.name == one.name; }))
        list.push_back(std::move(one));
}

/// Whether all methods of a scene have the seeds of its first one, so that they can be paired.
bool have_equal_seeds(const StudyResults& results) {
    std::map<std::string, std::map<std::string, std::set<std::size_t>>> seeds;  // by scene and method
    for (const CellResult& cell : results.cells)
        seeds[cell.scene][cell.method].insert(cell.repetition);
    return std::all_of(seeds.begin(), seeds.end(), [](const auto& scene) {
        return std::all_of(scene.second.begin(), scene.second.end(),
                           [&](const auto& method) { return method.second == scene.second.begin()->second; });
    });
}

/// Numbers the renders of each method, so that those of unequal seeds are compared in their order.
void count_renders(StudyResults& results) {
    std::map<std::pair<std::string, std::string>, std::size_t> counts;
    for (CellResult& cell : results.cells)
        cell.repetition = counts[{cell.scene, cell.method}]++;
}

}  // namespace

bool is_run_folder(const std::filesystem::path& folder) {
    return std::filesystem::exists(folder / kSummaryFile);
}

StudyResults read_run_results(std::span<const std::filesystem::path> folders) {
    std::vector<Run> runs;
    for (const std::filesystem::path& folder : folders)
        runs.push_back(read_run(folder));
    const std::set<std::string> keys = differing_keys(runs);
    StudyResults results;
    results.folder = folders.front();
    results.budgets = {"a budget of its own"};
    results.has_references = false;
    results.measured_by = {
        {"estimated_error", "estimated RMSE / mean", [](const PassRow& row) { return row.estimate; }}};
    results.planned = runs.size();
    std::vector<std::uint64_t> seeds;
    for (Run& run : runs) {
        CellResult& cell = run.cell;
        results.study += (results.study.empty() ? "" : ", ") + cell.folder.string();
        cell.budget = results.budgets.front();
        cell.scene =
            fmt::format("{} {} x {}", std::filesystem::path(run.scene_file).stem().string(), cell.width, cell.height);
        const Settings settings = chosen(run.settings, keys);
        cell.method = method_name(settings);
        const auto at = std::find(seeds.begin(), seeds.end(), cell.seed);
        cell.repetition = static_cast<std::size_t>(at - seeds.begin());
        if (at == seeds.end()) seeds.push_back(cell.seed);
        for (const CellResult* other : results.of(cell.scene, cell.method))
            if (other->repetition == cell.repetition) {  // the same render twice
                cell.method += " (" + cell.folder.filename().string() + ")";
                break;
            }
        add_once(results.scenes, SceneResult{cell.scene, run.scene_file, "", NAN, false});
        add_once(results.methods, MethodResult{cell.method, settings});
        results.cells.push_back(std::move(cell));
    }
    results.baseline = results.methods.front().name;
    if (!have_equal_seeds(results)) count_renders(results);
    return results;
}

}  // namespace treefarm
