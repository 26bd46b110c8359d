// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/foreign_format.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace treefarm {

std::string foreign_format_cure(const std::string& extension) {
    constexpr const char* kFromBlender =
        "export it from Blender as a Mitsuba scene (.xml) with the add-on mitsuba-blender";
    constexpr const char* kThroughBlender =
        "import it into Blender and export it as a Mitsuba scene (.xml) with the add-on mitsuba-blender";
    constexpr const char* kPbrt =
        "look for a Mitsuba version of it, or bring it into Blender and export it as a Mitsuba scene (.xml) with the "
        "add-on mitsuba-blender";
    constexpr const char* kMesh =
        "it is a mesh without camera and light: name it in a Mitsuba scene (.xml), in the filename of a shape";
    constexpr const char* kOtherMesh =
        "it is a mesh without camera and light: convert it to .ply or .obj (Blender does), and name that in a Mitsuba "
        "scene (.xml)";
    constexpr const char* kImage =
        "it is an image: give a Mitsuba scene (.xml) or a job (.toml); treefarm compare compares images";
    constexpr std::array<std::pair<std::string_view, const char*>, 21> cures = {{
        {".blend", kFromBlender},
        {".pbrt", kPbrt},
        {".gltf", kThroughBlender},
        {".glb", kThroughBlender},
        {".usd", kThroughBlender},
        {".usda", kThroughBlender},
        {".usdc", kThroughBlender},
        {".usdz", kThroughBlender},
        {".fbx", kThroughBlender},
        {".dae", kThroughBlender},
        {".abc", kThroughBlender},
        {".obj", kMesh},
        {".ply", kMesh},
        {".serialized", kMesh},
        {".stl", kOtherMesh},
        {".exr", kImage},
        {".png", kImage},
        {".hdr", kImage},
        {".jpg", kImage},
        {".json", "it is what a run says to programs: give a Mitsuba scene (.xml) or a job (.toml)"},
        {".csv", "it is what a run says to programs: give a Mitsuba scene (.xml) or a job (.toml)"},
    }};
    std::string lower = extension;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
    for (const auto& [name, cure] : cures)
        if (name == lower) return cure;
    return "give a Mitsuba scene (.xml)";
}

}  // namespace treefarm
