// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/finished_render.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/base/files/atomic_file.h"
#include "common/base/hash.h"
#include "common/plan/resolve/resolved_file.h"
#include "common/scene/pack/scene_codec.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// JSON object of summary.json; empty if the render has not ended, or the file is damaged.
Json read_summary(const fs::path& folder) {
    std::ifstream file(folder / "summary.json", std::ios::binary);
    Json json = Json::parse(file, nullptr, false);
    return json.is_object() ? json : Json::object();
}

std::string text_at(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

double number_at(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? found->get<double>() : 0.0;
}

std::string read_text(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

}  // namespace

RenderFigures read_figures(const fs::path& folder) {
    RenderFigures figures;
    const Json summary = read_summary(folder);
    figures.spp = static_cast<std::uint32_t>(number_at(summary, "spp"));
    figures.seconds = number_at(summary, "seconds");
    figures.image = folder / "image.exr";
    if (const auto error = summary.find("image_error"); error != summary.end() && error->is_object())
        if (error->contains("relative")) figures.error = number_at(*error, "relative");
    if (const auto target = summary.find("target"); target != summary.end() && target->is_object())
        figures.missed_target = target->contains("reached") && (*target)["reached"] == false;
    return figures;
}

bool holds_result(const fs::path& folder) {
    return text_at(read_summary(folder), "state") == "done" && fs::exists(folder / "image.exr");
}

bool holds_result_of(const fs::path& folder, const RenderRequest& request) {
    if (!holds_result(folder)) return false;
    const Json summary = read_summary(folder);
    return read_text(folder / "job.toml") == job_without_output(request.content.job) &&
           text_at(summary, "fingerprint") == hash_text(request.origin.fingerprint.hash()) &&
           text_at(summary, "scene_hash") == hash_text(content_hash(encode_scene(request.content.scene)));
}

bool restore_output(const fs::path& folder, const std::string& file) {
    if (file.empty() || fs::exists(file)) return true;
    // The run directory has a copy of a PNG output, too: the preview.
    const fs::path from = folder / (fs::path(file).extension() == ".png" ? "preview.png" : "image.exr");
    const std::string bytes = read_text(from);
    if (bytes.empty()) return false;
    write_file_atomically(file, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return true;
}

}  // namespace treefarm
