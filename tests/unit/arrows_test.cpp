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

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = TREEFARM_SOURCE_DIR;

/// Rooms by level (docs/design/architecture.md): a room includes itself and rooms of lower levels, never its siblings.
const std::map<std::string, int> kLevels = {{"common/base", 0},
                                            {"common/math", 1},
                                            {"common/image", 2},
                                            {"common/film", 3},
                                            {"common/guiding", 3},
                                            {"common/metrics", 4},
                                            {"common/config", 4},
                                            {"common/scene", 5},
                                            {"common/scene/colour", 4},
                                            {"common/scene/readers", 6},
                                            {"common/plan", 7},
                                            {"common/protocol", 8},
                                            {"common/comm", 9},
                                            {"coordinator", 10},
                                            {"report", 10},
                                            {"serve", 10},
                                            {"worker/textures", 10},
                                            {"worker/geometry", 11},
                                            {"worker/shading", 11},
                                            {"worker/lights", 12},
                                            {"worker/camera", 12},
                                            {"worker/scene", 13},
                                            {"worker/integrators", 14},
                                            {"worker/guides", 15},
                                            {"worker/tools", 16},
                                            {"worker", 17},
                                            {"tests/support", 18},
                                            {"bench", 19},
                                            {"cli", 19}};

/// Beginnings of headers that include nothing of ours but each other, so that any room may include them.
const std::vector<std::string> kLeaves = {"common/plan/policy.h", "common/plan/effects/"};

const std::set<std::string> kPure = {"common/metrics", "common/guiding", "common/film", "common/plan"};

/// Clocks, threads, files, terminals and unkeyed randomness; our own headers that bring them along.
const std::vector<std::string> kImpure = {"chrono",
                                          "ctime",
                                          "thread",

                                          "fstream",
                                          "iostream",
                                          "filesystem",
                                          "random",
                                          "spdlog/",
                                          "mpi.h",
                                          "embree",
                                          "common/base/log.h",
                                          "common/base/timer.h",
                                          "common/image/exr.h",
                                          "common/image/png.h",
                                          "common/image/atomic_file.h"};

/// A library and the only room that may see it.
struct Owner {
    std::string header;  ///< how its includes begin
    std::string module;
};
const std::vector<Owner> kOwners = {
    {"mpi.h", "common/comm"},      {"mpi-ext.h", "common/comm"}, {"embree3/", "worker/geometry"},
    {"embree", "worker/geometry"}, {"Imf", "common/image"},      {"OpenEXR/", "common/image"},
    {"Iex", "common/image"},       {"stb/", "common/image"},     {"png.h", "common/image"},
    {"jpeglib", "common/image"},   {"stb_", "common/image"},     {"CLI/", "cli"},
    {"sodium", "common/comm"},     {"httplib.h", "serve"}};

struct Include {
    std::string target;
    bool quoted = false;
    int line = 0;
};

bool starts_with(const std::string& text, const std::string& start) {
    return text.compare(0, start.size(), start) == 0;
}

/// The room that a path from the root lies in; nothing for other files.
std::optional<std::string> module_of(const std::string& path) {
    std::optional<std::string> best;
    for (const auto& [module, level] : kLevels)
        if (starts_with(path, module + "/") && (!best || module.size() > best->size())) best = module;
    return best;
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

bool is_leaf(const std::string& path) {
    return std::any_of(kLeaves.begin(), kLeaves.end(), [&](const auto& leaf) { return starts_with(path, leaf); });
}

/// The folder of one estimator that a path lies in; none for what several share.
std::string estimator_of(const std::string& path) {
    const std::string module = "worker/integrators/";
    const std::size_t end = path.find('/', module.size());
    if (!starts_with(path, module) || end == std::string::npos) return "";
    const std::string folder = path.substr(module.size(), end - module.size());
    return folder == "subpath" ? "" : folder;
}

/// The folder of one guide that a path lies in; none for what they share.
std::string guide_of(const std::string& path) {
    const std::string module = "common/guiding/";
    const std::size_t end = path.find('/', module.size());
    if (!starts_with(path, module) || end == std::string::npos) return "";
    const std::string folder = path.substr(module.size(), end - module.size());
    return folder == "regions" || folder == "statistics" ? "" : folder;
}

/// The fault of one include of one file; empty if it has none.
std::string violation(const std::string& path, const Include& include) {
    const auto module = module_of(path);
    if (!module) return "the file lies in no room of docs/design/architecture.md";
    if (include.quoted && is_leaf(include.target)) return "";
    const auto target = module_of(include.target);
    if (is_leaf(path) && target) return "a leaf includes nothing of ours";
    if (target && *target != *module) {
        const bool worker = starts_with(*module, "worker"), to_worker = starts_with(*target, "worker");
        if ((worker && *target == "coordinator") || (*module == "coordinator" && to_worker))
            return "coordinator and worker never include each other";
        if (kLevels.at(*target) >= kLevels.at(*module)) return *module + " must not look at " + *target;
    }
    const std::string from = estimator_of(path), to = estimator_of(include.target);
    if (!from.empty() && !to.empty() && from != to) return "integrators never include each other";
    const std::string guide = guide_of(include.target);
    if (!guide.empty() && (starts_with(path, "worker/integrators/") || *module == "coordinator" || *module == "cli"))
        return "integrators, coordinator and commands know guides by common/guiding/any_guide.h alone";
    if (!guide.empty() && *module == "common/guiding" && guide != guide_of(path) && path != "common/guiding/guides.h")
        return "guides never include each other, nor does what they share";
    if (include.quoted && !target) return "a quoted include must be a full path from the root into a room";
    if (!include.quoted && target) return "our own headers are included in quotes";
    // Benchmarks hold a library, used as it is, against our use of it.
    for (const Owner& owner : kOwners)
        if (starts_with(include.target, owner.header) && *module != owner.module && *module != "bench")
            return "only " + owner.module + " sees " + owner.header;
    if (kPure.count(*module) > 0)
        for (const std::string& impure : kImpure)
            if (include.target == impure || (impure.back() == '/' && starts_with(include.target, impure)))
                return *module + " is pure: no " + impure;
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

TEST(Arrows, LeavesAreThere) {
    for (const std::string& leaf : kLeaves)
        EXPECT_TRUE(fs::exists(kRoot / leaf)) << leaf;
}

TEST(Arrows, TheRulesCatchWhatTheyForbid) {
    const struct {
        const char *file, *include;
    } forbidden[] = {
        {"common/base/hash.cpp", "#include \"common/math/vec.h\""},
        {"common/film/pass_film.h", "#include \"common/guiding/sd_tree/sd_tree_sampler.h\""},
        {"common/metrics/z_test.h", "#include \"common/config/job.h\""},
        {"common/plan/schedule.cpp", "#include \"common/comm/channel.h\""},
        {"coordinator/pass_loop.cpp", "#include \"worker/worker.h\""},
        {"coordinator/pass_loop.cpp", "#include \"worker/geometry/scene.h\""},
        {"worker/tile.cpp", "#include \"coordinator/ledger.h\""},
        {"worker/shading/diffuse.h", "#include \"coordinator/ledger.h\""},
        {"worker/shading/diffuse.h", "#include \"worker/geometry/device.h\""},
        {"worker/lights/area.h", "#include \"worker/integrators/walk.h\""},
        {"common/comm/channel.h", "#include \"cli/compare.h\""},
        {"cli/main.cpp", "#include <mpi.h>"},
        {"coordinator/pass_loop.cpp", "#include <mpi.h>"},
        {"worker/integrators/walk.cpp", "#include <embree3/rtcore.h>"},
        {"worker/lights/area.cpp", "#include <embree4/rtcore.h>"},
        {"cli/compare.cpp", "#include <ImfInputFile.h>"},
        {"common/scene/model/texture.cpp", "#include <OpenEXR/ImfRgbaFile.h>"},
        {"common/scene/model/texture.cpp", "#  include <stb/stb_image.h>"},
        {"coordinator/study.cpp", "#include <CLI/CLI.hpp>"},
        {"common/metrics/a.cpp", "#include <chrono>"},
        {"common/guiding/a.cpp", "#include <thread>"},
        {"common/film/a.cpp", "#include <fstream>"},
        {"common/plan/a.cpp", "#include <iostream>"},
        {"common/guiding/a.cpp", "#include <random>"},
        {"common/plan/a.cpp", "#include <spdlog/spdlog.h>"},
        {"common/film/a.cpp", "#include \"common/base/log.h\""},
        {"common/metrics/a.cpp", "#include \"common/image/exr.h\""},
        {"common/film/a.cpp", "#include \"pixel_estimate.h\""},
        {"common/film/a.cpp", "#include <common/film/pixel_estimate.h>"},
        {"common/other/a.cpp", "#include <vector>"},
        {"common/plan/policy.h", "#include \"common/math/vec.h\""},
        {"common/plan/effects/light.h", "#include \"common/plan/effect_finder.h\""},
        {"worker/integrators/light/walk.h", "#include \"worker/integrators/path/path_walk.h\""},
        {"worker/integrators/path/path_walk.h", "#include \"worker/guides/sd_tree_walk.h\""},
        {"worker/integrators/path/path_walk.h", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"coordinator/collector.h", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"cli/inspect.cpp", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"common/guiding/regions/mixture.h", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"common/guiding/lobes/lobes.h", "#include \"common/guiding/sd_tree/sd_tree.h\""},
        {"report/html.cpp", "#include \"coordinator/farm.h\""},
        {"serve/site.cpp", "#include \"coordinator/farm.h\""},
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
        {"worker/integrators/walk.cpp", "#include \"worker/geometry/device.h\""},
        {"worker/integrators/light/walk.h", "#include \"worker/integrators/subpath/mis.h\""},
        {"worker/integrators/registry.cpp", "#include \"worker/integrators/path/path_integrator.h\""},
        {"worker/worker.cpp", "#include \"common/comm/channel.h\""},
        {"worker/guides/sd_tree_walk.h", "#include \"common/guiding/sd_tree/sd_tree_sampler.h\""},
        {"worker/guides/sd_tree_walk.h", "#include \"worker/integrators/path/path_walk.h\""},
        {"coordinator/collector.h", "#include \"common/guiding/any_guide.h\""},
        {"cli/render.cpp", "#include \"worker/worker.h\""},
        {"serve/web_server.cpp", "#include <httplib.h>"},
        {"coordinator/pass_loop.cpp", "#include <chrono>"},
        {"common/metrics/z_test.cpp", "#include \"common/image/image.h\""},
        {"common/config/effect_switches.cpp", "#include \"common/plan/effects/table.h\""},
        {"common/plan/effects/table.h", "#include \"common/plan/effects/light.h\""},
    };
    for (const auto& [file, include] : allowed)
        EXPECT_EQ(check(file, include), "") << file << ": " << include;
}

}  // namespace
