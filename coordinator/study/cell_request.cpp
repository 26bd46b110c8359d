// SPDX-License-Identifier: Apache-2.0
#include "coordinator/study/cell_request.h"

#include "common/base/hash.h"
#include "common/config/check_job.h"
#include "common/config/job_reader.h"
#include "common/image/exr.h"
#include "common/runs/run_json.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/render/read_request.h"

namespace treefarm {

namespace {

/// Job with the layers that are known before the scene is read.
Job scene_job(const Study& study, const StudyScene& scene) {
    Job job;
    apply_layer(job, study.job);
    apply_layer(job, scene.settings);
    job.scene.file = scene.file;
    return job;
}

}  // namespace

LoadedScene load_study_scene(const Study& study, const StudyScene& scene) {
    const Job job = scene_job(study, scene);
    return load_scene(scene.file, job.scene.defines, job.scene.lenient, job.image.width, job.image.height,
                      job.scene.sensor, scene_limits(job.scene));
}

RenderRequest study_request(const Study& study, const StudyScene& scene, const LoadedScene& loaded,
                            std::span<const Setting> method, std::span<const Setting> more,
                            const RenderOrigin& origin) {
    RenderContent content;
    content.job = merged_job(loaded, {study.job, scene.settings, method, more});
    content.job.scene.file = scene.file;
    check_job(content.job);
    content.scene = loaded.scene;
    content.plan = plan_effects(content.scene, content.job);
    take_warnings(loaded, content);
    content.plan.warnings = content.warnings;
    return {.content = std::move(content), .origin = origin};
}

std::vector<Setting> cell_settings(const Study& study, const StudyCell& cell) {
    std::vector<Setting> settings = {study.budgets[cell.budget]};
    settings.push_back({"sampler.seed", std::to_string(cell.seed), Location{study.file}});
    return settings;
}

std::string cell_words(const Study& study, const StudyCell& cell) {
    const std::string budget = study.budgets.size() > 1 ? "." + study.budgets[cell.budget].value : "";
    return study.scenes[cell.scene].name + "." + study.methods[cell.method].name + budget + "." +
           std::to_string(cell.seed);
}

std::uint64_t request_key(const RenderRequest& request, const std::string& more) {
    Job job = request.content.job;
    job.output = {};
    const std::string text = write_job(job) + hash_text(content_hash(encode_scene(request.content.scene))) +
                             hash_text(request.origin.fingerprint.hash()) + more;
    return hash_bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string folder_name(const std::string& words, std::uint64_t key) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.";
    std::string name = words.substr(0, 100);
    for (char& c : name)
        if (plain.find(c) == std::string_view::npos) c = '_';
    return name + "-" + hash_text(key);
}

bool ReadyCell::done() const {
    // A damaged file is none.
    return !read_run_json(folder / kCellFile).empty() && is_exr_file(folder / kImageFile);
}

ReadyCell ready_cell(const Study& study, const StudyCell& cell, const LoadedScene& loaded,
                     const std::string& reference_key, const RenderOrigin& origin) {
    ReadyCell ready;
    ready.request = study_request(study, study.scenes[cell.scene], loaded, study.methods[cell.method].settings,
                                  cell_settings(study, cell), origin);
    ready.folder = std::filesystem::path(study.directory) / "cells" /
                   folder_name(cell_words(study, cell), request_key(ready.request, reference_key));
    return ready;
}

}  // namespace treefarm
