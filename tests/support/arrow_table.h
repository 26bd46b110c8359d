// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

/// What tests/unit/tree/arrows_test.cpp holds includes against.
namespace treefarm::test::arrows {

/// Folders that hold sources, floor by floor (docs/design/architecture.md): a file includes its own folder's headers
/// and those of earlier floors, never those of its own floor's other folders.
inline const std::vector<std::vector<std::string>> kFloors = {
    {"common/base/text", "common/config/effects"},
    {"common/base"},
    {"common/base/files", "common/math"},
    {"common/image", "common/film", "common/guiding/statistics", "common/scene/kinds/traits"},
    {"common/metrics", "common/guiding/regions", "common/scene/kinds/emitters", "common/scene/kinds/materials",
     "common/scene/kinds/shapes", "common/scene/kinds/textures"},
    {"common/metrics/flip", "common/guiding/grid", "common/guiding/qtable", "common/guiding/sd_tree",
     "common/scene/kinds"},
    {"common/guiding"},
    {"common/config", "common/scene/model"},
    {"common/scene/uses"},
    {"common/scene/pack", "common/plan/resolve"},
    {"common/plan/schedule"},
    {"common/plan/forecast"},
    {"common/plan/effects", "common/protocol"},
    {"common/comm"},
    {"coordinator/input/colour", "coordinator/input/images", "coordinator/input/check", "worker/textures", "report",
     "serve"},
    {"coordinator/input/meshes", "coordinator/input/lint", "worker/geometry", "worker/shading"},
    {"coordinator/input/mitsuba", "worker/lights", "worker/camera"},
    {"coordinator/input", "worker/scene"},
    {"coordinator/farm", "worker/integrators/subpath"},
    {"coordinator/passes", "worker/integrators"},
    {"coordinator/words", "coordinator/checkpoint", "coordinator/display", "worker/integrators/ao",
     "worker/integrators/bidirectional", "worker/integrators/direct", "worker/integrators/first_hit",
     "worker/integrators/light", "worker/integrators/normals", "worker/integrators/path",
     "worker/integrators/reference"},
    {"coordinator/run", "worker/guides"},
    {"coordinator/launch", "coordinator/render", "worker/tools"},
    {"coordinator/shot", "coordinator/study", "worker"},
    {"tests/support"},
    {"bench", "cli"}};

/// Top folders and the other top folders that they may see.
inline const std::map<std::string, std::set<std::string>> kSides = {
    {"common", {}},
    {"coordinator", {"common"}},
    {"worker", {"common"}},
    {"report", {"common"}},
    {"serve", {"common"}},
    {"tests", {"common", "coordinator", "worker"}},
    {"bench", {"common", "coordinator", "worker", "tests"}},
    {"cli", {"common", "coordinator", "worker", "report", "serve"}}};

/// Folders, with all below them, that are pure.
inline const std::vector<std::string> kPure = {"common/metrics", "common/guiding", "common/film", "common/plan"};

/// Clocks, threads, files, terminals and unkeyed randomness; our own headers that bring them along.
inline const std::vector<std::string> kImpure = {"chrono",
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
                                                 "common/base/files/",
                                                 "common/image/exr.h",
                                                 "common/image/png.h"};

/// A library and the only folder that may see it.
struct Owner {
    std::string header;  ///< how its includes begin
    std::string folder;
};
inline const std::vector<Owner> kOwners = {{"mpi.h", "common/comm"},
                                           {"mpi-ext.h", "common/comm"},
                                           {"sodium", "common/comm"},
                                           {"embree3/", "worker/geometry"},
                                           {"embree", "worker/geometry"},
                                           {"Imf", "common/image"},
                                           {"OpenEXR/", "common/image"},
                                           {"Iex", "common/image"},
                                           {"png.h", "coordinator/input/images"},
                                           {"jpeglib", "coordinator/input/images"},
                                           {"stb/", "coordinator/input/images"},
                                           {"stb_", "coordinator/input/images"},
                                           {"pugixml", "coordinator/input/mitsuba"},
                                           {"CLI/", "cli"},
                                           {"httplib.h", "serve"}};

}  // namespace treefarm::test::arrows
