// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/arrow_table.h"
#include "tests/support/source_root.h"

namespace {

namespace fs = std::filesystem;
using namespace treefarm::test::arrows;

using treefarm::test::kRoot;

struct Include {
    std::string target;
    bool quoted = false;
    int line = 0;
};

bool starts_with(const std::string& text, const std::string& start) {
    return text.compare(0, start.size(), start) == 0;
}

/// Whether a path is this folder or lies below it.
bool below(const std::string& path, const std::string& folder) {
    return path == folder || starts_with(path, folder + "/");
}

std::string folder_of(const std::string& path) {
    const std::size_t end = path.rfind('/');
    return end == std::string::npos ? "" : path.substr(0, end);
}

std::string top_of(const std::string& path) {
    return path.substr(0, path.find('/'));
}

/// The floor of a folder; nothing for one that is not in the table.
std::optional<std::size_t> floor_of(const std::string& folder) {
    for (std::size_t floor = 0; floor < kFloors.size(); ++floor)
        if (std::count(kFloors[floor].begin(), kFloors[floor].end(), folder) > 0) return floor;
    return std::nullopt;
}

/// The include that a line holds, if any. By hand: GCC 12 warns about std::regex under the address sanitizer.
std::optional<Include> include_in(const std::string& text, int line) {
    const auto skip_blanks = [&](std::size_t at) { return std::min(text.find_first_not_of(" \t", at), text.size()); };
    std::size_t at = skip_blanks(0);
    if (text.compare(at, 1, "#") != 0) return std::nullopt;
    at = skip_blanks(at + 1);
    const std::string word = "include";
    if (text.compare(at, word.size(), word) != 0) return std::nullopt;
    at = skip_blanks(at + word.size());
    const bool quoted = text.compare(at, 1, "\"") == 0;
    if (!quoted && text.compare(at, 1, "<") != 0) return std::nullopt;
    const std::size_t end = text.find(quoted ? '"' : '>', at + 1);
    if (end == std::string::npos) return std::nullopt;
    return Include{text.substr(at + 1, end - at - 1), quoted, line};
}

std::vector<Include> includes_of(std::istream& source) {
    std::vector<Include> includes;
    std::string text;
    for (int line = 1; std::getline(source, text); ++line)
        if (const auto include = include_in(text, line)) includes.push_back(*include);
    return includes;
}

/// Whether a folder is that of one guide: all below common/guiding but for what guides share.
bool is_guide(const std::string& folder) {
    return starts_with(folder, "common/guiding/") && folder != "common/guiding/regions" &&
           folder != "common/guiding/statistics";
}

/// The fault of one include of one file; empty if it has none.
std::string violation(const std::string& path, const Include& include) {
    const std::string folder = folder_of(path), target = folder_of(include.target);
    const auto floor = floor_of(folder), target_floor = floor_of(target);
    if (!floor) return "the folder " + folder + " is not in the table of this test";
    if (include.quoted && !target_floor) return "a quoted include must be a full path from the root into a module";
    if (!include.quoted && target_floor) return "our own headers are included in quotes";
    if (target_floor && target != folder) {
        if (top_of(target) != top_of(folder) && kSides.at(top_of(folder)).count(top_of(target)) == 0)
            return top_of(folder) + " never includes " + top_of(target);
        if (*target_floor >= *floor) return folder + " must not look at " + target;
    }
    if (is_guide(target) &&
        (below(folder, "worker/integrators") || folder == "worker" || below(folder, "coordinator") || folder == "cli"))
        return "integrators, coordinator and commands know guides by common/guiding/any_guide.h alone";
    if (is_guide(target) && folder == "common/guiding" && path != "common/guiding/guides.h")
        return "common/guiding/guides.h alone lists the guides";
    // Benchmarks hold a library, used as it is, against our use of it.
    for (const Owner& owner : kOwners)
        if (!include.quoted && starts_with(include.target, owner.header) && folder != owner.folder && folder != "bench")
            return "only " + owner.folder + " sees " + owner.header;
    for (const std::string& pure : kPure)
        for (const std::string& impure : kImpure)
            if (below(folder, pure) &&
                (include.target == impure || (impure.back() == '/' && starts_with(include.target, impure))))
                return pure + " is pure: no " + impure;
    return "";
}

std::string check(const std::string& path, const std::string& line) {
    std::istringstream source(line);
    const auto includes = includes_of(source);
    return includes.empty() ? "not an include" : violation(path, includes[0]);
}

std::vector<fs::path> sources() {
    std::vector<fs::path> files;
    for (const char* folder : {"common", "coordinator", "worker", "report", "serve", "cli", "bench"})
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
            if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

TEST(Arrows, EveryIncludePointsDownwards) {
    const auto files = sources();
    ASSERT_GT(files.size(), 20u) << "no sources below " << kRoot;
    for (const fs::path& file : files) {
        std::ifstream source(file);
        const std::string path = fs::relative(file, kRoot).generic_string();
        for (const Include& include : includes_of(source)) {
            const std::string wrong = violation(path, include);
            EXPECT_EQ(wrong, "") << path << ":" << include.line << ": #include of " << include.target;
            if (include.quoted) {
                EXPECT_TRUE(fs::exists(kRoot / include.target))
                    << path << ":" << include.line << ": no such file from the root: " << include.target;
            }
        }
    }
}

TEST(Arrows, TheTableHasEveryFolderWithSourcesAndNoOther) {
    std::set<std::string> there = {"tests/support"};
    for (const fs::path& file : sources())
        there.insert(folder_of(fs::relative(file, kRoot).generic_string()));
    std::multiset<std::string> listed;
    for (const auto& floor : kFloors)
        listed.insert(floor.begin(), floor.end());
    for (const std::string& folder : there)
        EXPECT_EQ(listed.count(folder), 1u) << folder << " has sources, so it stands in the table once";
    for (const std::string& folder : listed)
        EXPECT_EQ(there.count(folder), 1u) << folder << " is in the table, but has no sources";
}

TEST(Arrows, TheCoordinatorsFilesHaveFoldersOfTheirOwn) {
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(kRoot / "coordinator"))
        files += entry.is_regular_file();
    EXPECT_LE(files, 6u);
}

TEST(Arrows, TheRulesCatchWhatTheyForbid) {
    const struct {
        const char *file, *include;
    } forbidden[] = {
        {"common/base/hash.cpp", "#include \"common/math/vec.h\""},
        {"common/film/pass_film.h", "#include \"common/guiding/sd_tree/sd_tree_sampler.h\""},
        {"common/metrics/z_test.h", "#include \"common/config/job.h\""},
        {"common/plan/schedule/schedule.cpp", "#include \"common/comm/channel.h\""},
        {"coordinator/passes/pass_loop.cpp", "#include \"worker/worker.h\""},
        {"coordinator/passes/pass_loop.cpp", "#include \"worker/geometry/scene.h\""},
        {"worker/tile.cpp", "#include \"coordinator/farm/ledger.h\""},
        {"worker/shading/diffuse.h", "#include \"coordinator/farm/ledger.h\""},
        {"worker/shading/diffuse.h", "#include \"worker/geometry/device.h\""},
        {"worker/lights/area.h", "#include \"worker/integrators/walk.h\""},
        {"common/comm/channel.h", "#include \"cli/compare.h\""},
        {"cli/main.cpp", "#include <mpi.h>"},
        {"coordinator/passes/pass_loop.cpp", "#include <mpi.h>"},
        {"worker/integrators/walk.cpp", "#include <embree3/rtcore.h>"},
        {"worker/lights/area.cpp", "#include <embree4/rtcore.h>"},
        {"cli/compare.cpp", "#include <ImfInputFile.h>"},
        {"common/scene/model/texture.cpp", "#include <OpenEXR/ImfRgbaFile.h>"},
        {"common/scene/model/texture.cpp", "#  include <stb/stb_image.h>"},
        {"coordinator/study/study_run.cpp", "#include <CLI/CLI.hpp>"},
        {"common/metrics/a.cpp", "#include <chrono>"},
        {"common/guiding/a.cpp", "#include <thread>"},
        {"common/film/a.cpp", "#include <fstream>"},
        {"common/plan/schedule/a.cpp", "#include <iostream>"},
        {"common/guiding/a.cpp", "#include <random>"},
        {"common/plan/resolve/a.cpp", "#include <spdlog/spdlog.h>"},
        {"common/film/a.cpp", "#include \"common/base/log.h\""},
        {"common/metrics/a.cpp", "#include \"common/image/exr.h\""},
        {"common/film/a.cpp", "#include \"pixel_estimate.h\""},
        {"common/film/a.cpp", "#include <common/film/pixel_estimate.h>"},
        {"common/other/a.cpp", "#include <vector>"},
        {"common/base/policy.h", "#include \"common/math/vec.h\""},
        {"common/config/effects/light.h", "#include \"common/plan/effects/effect_finder.h\""},
        {"worker/integrators/light/walk.h", "#include \"worker/integrators/path/path_walk.h\""},
        {"worker/integrators/path/path_walk.h", "#include \"worker/guides/sd_tree_walk.h\""},
        {"worker/integrators/path/path_walk.h", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"coordinator/farm/collector.h", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"cli/inspect.cpp", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"common/guiding/regions/mixture.h", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"common/guiding/lobes/lobes.h", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"common/guiding/grid/grid.h", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"common/guiding/any_guide.h", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"common/guiding/statistics/cell_sums.h", "#include \"common/guiding/regions/region_model.h\""},
        {"common/film/a.cpp", "#include \"common/base/files/atomic_file.h\""},
        {"common/scene/kinds/materials/blend.h", "#include \"common/scene/model/texture.h\""},
        {"common/scene/model/scene.cpp", "#include \"common/scene/uses/material_uses.h\""},
        {"common/plan/resolve/resolve.cpp", "#include \"common/plan/schedule/schedule.h\""},
        {"common/plan/effects/effects.cpp", "#include \"coordinator/input/lint/light_reach.h\""},
        {"worker/scene/trace_scene.cpp", "#include \"coordinator/input/load.h\""},
        {"coordinator/input/load.cpp", "#include \"coordinator/run/render_run.h\""},
        {"coordinator/farm/farm.h", "#include \"coordinator/run/render_run.h\""},
        {"coordinator/run/render_run.h", "#include \"coordinator/launch/supervisor.h\""},
        {"coordinator/launch/launch_run.cpp", "#include \"cli/launch_environment.h\""},
        {"common/image/a.cpp", "#include <png.h>"},
        {"report/html.cpp", "#include \"coordinator/farm/farm.h\""},
        {"serve/site.cpp", "#include \"coordinator/farm/farm.h\""},
        {"cli/serve.cpp", "#include <httplib.h>"},
    };
    for (const auto& [file, include] : forbidden)
        EXPECT_NE(check(file, include), "") << file << ": " << include;
}

TEST(Arrows, TheRulesLetThroughWhatIsAllowed) {
    const struct {
        const char *file, *include;
    } allowed[] = {
        {"common/comm/mpi_channel.cpp", "#include <mpi.h>"},
        {"worker/geometry/device.cpp", "#include <embree3/rtcore.h>"},
        {"worker/geometry/device.cpp", "#include <embree4/rtcore.h>"},
        {"common/image/exr_read.cpp", "#include <ImfHeader.h>"},
        {"common/math/vec.h", "#include <Imath/ImathVec.h>"},
        {"common/film/combine.cpp", "#include \"common/film/combine.h\""},
        {"worker/integrators/sample_loop.cpp", "#include \"worker/geometry/device.h\""},
        {"worker/integrators/light/walk.h", "#include \"worker/integrators/subpath/mis.h\""},
        {"worker/registry.cpp", "#include \"worker/integrators/first_hit/first_hit.h\""},
        {"worker/worker.cpp", "#include \"common/comm/channel.h\""},
        {"worker/guides/sd_tree_walk.h", "#include \"common/guiding/sd_tree/sd_tree_sampler.h\""},
        {"worker/guides/sd_tree_walk.h", "#include \"worker/integrators/path/path_walk.h\""},
        {"coordinator/farm/collector.h", "#include \"common/guiding/any_guide.h\""},
        {"cli/render.cpp", "#include \"worker/worker.h\""},
        {"serve/web_server.cpp", "#include <httplib.h>"},
        {"coordinator/passes/pass_loop.cpp", "#include <chrono>"},
        {"common/metrics/z_test.cpp", "#include \"common/image/image.h\""},
        {"coordinator/input/images/png_decode.cpp", "#include <png.h>"},
        {"coordinator/run/run_directory.cpp", "#include \"common/image/png.h\""},
        {"common/config/effect_switches.cpp", "#include \"common/config/effects/table.h\""},
        {"common/config/effects/table.h", "#include \"common/config/effects/light.h\""},
    };
    for (const auto& [file, include] : allowed)
        EXPECT_EQ(check(file, include), "") << file << ": " << include;
}

}  // namespace
