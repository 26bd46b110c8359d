// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

/// Rules that tests/unit/tree/arrows_test.cpp checks includes against.
namespace treefarm::test::arrows {

/// Folders with sources, floor by floor (docs/design/architecture.md): a file may include headers of its own folder and
/// of earlier floors, but not of other folders on its own floor.
inline const std::vector<std::vector<std::string>> kFloors = {
    {"common/base/text", "common/config/effects"},
    {"common/base"},
    {"common/base/files", "common/math"},
    {"common/image", "common/film", "common/evidence", "common/scene/kinds/traits"},
    {"common/metrics", "common/decide/pixels", "common/scene/kinds/emitters", "common/scene/kinds/materials",
     "common/scene/kinds/shapes", "common/scene/kinds/textures"},
    {"common/metrics/flip", "common/decide/pass", "common/scene/kinds"},
    {"common/decide/guiding", "common/decide/splitting", "common/decide/next_event", "common/decide/light_subpaths",
     "common/decide/emission"},
    {"common/decide", "common/guiding/statistics"},
    {"common/runs", "common/guiding/regions"},
    {"common/guiding/beside", "common/guiding/grid", "common/guiding/qtable", "common/guiding/sd_tree"},
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

/// Top folders, with the other top folders that they may include.
inline const std::map<std::string, std::set<std::string>> kSides = {
    {"common", {}},
    {"coordinator", {"common"}},
    {"worker", {"common"}},
    {"report", {"common"}},
    {"serve", {"common"}},
    {"tests", {"common", "coordinator", "worker"}},
    {"bench", {"common", "coordinator", "worker", "tests"}},
    {"cli", {"common", "coordinator", "worker", "report", "serve"}}};

/// Folders that are pure, with all below them.
inline const std::vector<std::string> kPure = {"common/metrics",  "common/guiding", "common/film",
                                               "common/evidence", "common/decide",  "common/plan"};

/// Headers of clocks, threads, files, terminals and unkeyed randomness, and our own headers that include them.
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

/// A library, with the only folder that may include it.
struct Owner {
    std::string header;  ///< prefix of its includes
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
