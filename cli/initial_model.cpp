// SPDX-License-Identifier: Apache-2.0
#include "cli/initial_model.h"

#include <algorithm>
#include <filesystem>

#include "common/base/hash.h"
#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "common/image/read_bytes.h"
#include "common/plan/resolved_file.h"
#include "common/plan/schedule_file.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

constexpr const char* kKey = "guiding.initial_model";

[[noreturn]] void refuse(const fs::path& where, const std::string& what, const std::string& cure) {
    throw InputError(Location{where.string(), 0, 0}, what, cure);
}

/// Keys that say what a model's densities are of.
void check_guide(const fs::path& run, const Job& before, const Job& now) {
    for (const char* name : {"guiding.type", "guiding.target", "guiding.view_records"}) {
        const JobKey& key = *find_job_key(name);
        if (key.print(before) != key.print(now))
            refuse(run,
                   std::string("its model is another guide's: ") + name + " was \"" + key.print(before) + "\", is \"" +
                       key.print(now) + "\"",
                   std::string("leave ") + kKey + " away, or render both alike");
    }
}

AnyModel decoded(const fs::path& file, std::span<const std::uint8_t> bytes) {
    try {
        return AnyModel::decode(bytes);
    } catch (const FormatError& error) {
        refuse(file, error.what(), "render that frame again");
    }
}

}  // namespace

void read_initial_model(RenderRequest& request) {
    Job::Guiding& guiding = request.job.guiding;
    const Resolved resolved = resolve(request.job, request.scene);
    if (guiding.initial_model.empty() || !resolved.guides) return;
    guiding.initial_model = fs::absolute(guiding.initial_model).lexically_normal().string();
    const fs::path run = guiding.initial_model, file = run / "tree.bin";
    if (!fs::exists(run / "resolved.toml") || !fs::exists(run / "schedule.toml"))
        refuse(run, "is no run directory", std::string("name one with ") + kKey);
    const Job before =
        read_resolved(read_settings_text(run / "resolved.toml", "job"), (run / "resolved.toml").string());
    check_guide(run, before, resolved);
    const std::vector<PassPlan> passes = parse_schedule(read_settings_text(run / "schedule.toml", "schedule"),
                                                        (run / "schedule.toml").string(), resolved);
    const auto teacher = std::find_if(passes.rbegin(), passes.rend(), [](const PassPlan& pass) { return pass.record; });
    // One whose passes taught nothing hands on the model that it began with.
    const bool has_learned = teacher != passes.rend() || !before.guiding.initial_model.empty();
    if (!fs::exists(file) || !has_learned || !passes.back().guided) {
        request.warnings.push_back(run.string() + " has no model to begin with: it " +
                                   (fs::exists(file) ? "gave guiding up" : "has learned none"));
        guiding.initial_model.clear();
        return;
    }
    const std::vector<std::uint8_t> bytes = read_bytes(file, "render that frame again");
    const std::string hash = hash_text(hash_bytes(bytes));
    if (!guiding.initial_model_hash.empty() && guiding.initial_model_hash != hash)
        refuse(file,
               "is not the model that guiding.initial_model_hash says: " + hash + ", not " + guiding.initial_model_hash,
               "render that frame again as it was, or leave the hash away");
    guiding.initial_model_hash = hash;
    guiding.initial_model_spp =
        teacher != passes.rend() ? static_cast<int>(teacher->spp) : before.guiding.initial_model_spp;
    request.initial_model = decoded(file, bytes);
    request.initial_model->set_learns_lights(resolved.learns_lights);
}

}  // namespace treefarm
