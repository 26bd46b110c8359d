// SPDX-License-Identifier: Apache-2.0
#include "coordinator/shot/finished_frame.h"

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

/// An object without keys if the render has not ended, or the file is damaged.
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

void read_figures(const fs::path& folder, FrameRecord& record) {
    const Json summary = read_summary(folder);
    record.spp = static_cast<std::uint32_t>(number_at(summary, "spp"));
    record.seconds = number_at(summary, "seconds");
    record.image = folder / "image.exr";
    if (const auto error = summary.find("image_error"); error != summary.end() && error->is_object())
        if (error->contains("relative")) record.error = number_at(*error, "relative");
    if (const auto target = summary.find("target"); target != summary.end() && target->is_object())
        record.missed_target = target->contains("reached") && (*target)["reached"] == false;
}

bool holds_result(const fs::path& folder) {
    return text_at(read_summary(folder), "state") == "done" && fs::exists(folder / "image.exr");
}

bool holds_result_of(const fs::path& folder, const RenderRequest& request) {
    if (!holds_result(folder)) return false;
    const Json summary = read_summary(folder);
    return read_text(folder / "job.toml") == job_without_output(request.job) &&
           text_at(summary, "fingerprint") == hash_text(request.fingerprint.hash()) &&
           text_at(summary, "scene_hash") == hash_text(content_hash(encode_scene(request.scene)));
}

bool restore_output(const fs::path& folder, const std::string& file) {
    if (file.empty() || fs::exists(file)) return true;
    // Of the picture to look at the run directory has a copy, too.
    const fs::path from = folder / (fs::path(file).extension() == ".png" ? "preview.png" : "image.exr");
    const std::string bytes = read_text(from);
    if (bytes.empty()) return false;
    write_file_atomically(file, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return true;
}

}  // namespace treefarm
