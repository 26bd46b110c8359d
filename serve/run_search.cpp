// SPDX-License-Identifier: Apache-2.0
#include "serve/run_search.h"

#include <algorithm>
#include <utility>

#include "common/runs/run_files.h"

namespace treefarm {

namespace {

struct Found {
    std::int64_t written = 0;
    std::string path;
};

class Search {
  public:
    Search(const ConfinedFolder& root, const SearchLimits& limits) : root_(root), limits_(limits) {}

    std::vector<Found> run() {
        look_into("", 0);
        return std::move(found_);
    }

  private:
    void look_into(const std::string& path, std::size_t depth) {
        if (looked_into_ == limits_.folders) return;
        ++looked_into_;
        if (const auto version = root_.version(joined_path(path, kStatusFile))) {
            found_.push_back({version->nanoseconds, path});
            return;  // a run's subfolders are its checkpoints and earlier runs
        }
        if (depth == limits_.depth) return;
        for (const std::string& name : root_.folders(path, limits_.folders))
            if (!name.starts_with('.')) look_into(joined_path(path, name), depth + 1);
    }

    const ConfinedFolder& root_;
    const SearchLimits limits_;
    std::size_t looked_into_ = 0;
    std::vector<Found> found_;
};

}  // namespace

bool is_run(const ConfinedFolder& root, const std::string& path) {
    return root.version(joined_path(path, kStatusFile)).has_value();
}

FoundRuns find_runs(const ConfinedFolder& root, const SearchLimits& limits) {
    std::vector<Found> found = Search(root, limits).run();
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
        return a.written != b.written ? a.written > b.written : a.path < b.path;
    });
    FoundRuns runs;
    for (Found& run : found) {
        if (runs.paths.size() < limits.runs)
            runs.paths.push_back(std::move(run.path));
        else
            ++runs.left_out;
    }
    return runs;
}

}  // namespace treefarm
