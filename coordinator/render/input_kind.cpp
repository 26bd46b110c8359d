// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "common/base/refuse.h"
#include "common/base/text/parse_text.h"
#include "common/runs/run_files.h"
#include "coordinator/input/foreign_format.h"
#include "coordinator/render/read_request.h"

namespace treefarm {

namespace {

constexpr const char* kSceneOrJob = "give a Mitsuba scene (.xml) or a job (.toml)";
constexpr const char* kStudy = "give a study file (.toml)";

/// Throws InputError for a folder, with advice.
[[noreturn]] void refuse_folder(const std::filesystem::path& folder, const char* otherwise) {
    const auto has = [&](const char* name) {
        std::error_code error;
        return std::filesystem::exists(folder / name, error);
    };
    const std::string input = folder.string();
    if (has(kStudyFile))
        refuse(input, "is the folder of a study",
               "give the study file to go on with it, or write treefarm report " + input);
    if (has(kShotFile))
        refuse(input, "is the folder of a shot",
               "its frames are run directories in it: treefarm render " +
                   shell_quoted((folder / "frame.0001" / kJobFile).string()));
    if (has(kJobFile))
        refuse(input, "is a run directory",
               "its job is a file in it: treefarm render " + shell_quoted((folder / kJobFile).string()));
    refuse(input, "is a folder", otherwise);
}

bool is_folder(const std::string& input) {
    std::error_code error;
    return std::filesystem::is_directory(input, error);
}

}  // namespace

void require_scene_or_job(const std::string& input) {
    if (input.empty()) refuse("input", "the name is empty", kSceneOrJob);
    if (is_folder(input)) refuse_folder(input, kSceneOrJob);
    const std::string extension = std::filesystem::path(input).extension().string();
    if (extension == ".xml" || extension == ".toml") return;
    const std::string cure = foreign_format_cure(extension);
    refuse(input, extension.empty() ? "the name has no extension" : in_quotes(extension) + " files cannot be rendered",
           cure == foreign_format_cure("") ? kSceneOrJob : cure);
}

void require_study_file(const std::string& input) {
    if (input.empty()) refuse("input", "the name is empty", kStudy);
    if (is_folder(input)) refuse_folder(input, kStudy);
    const std::string extension = std::filesystem::path(input).extension().string();
    if (extension == ".toml") return;
    if (extension == ".xml")
        refuse(input, "is a scene, and a study names scenes in a file of its own (.toml)",
               "write treefarm render " + shell_quoted(input) + ", or see docs/use/studies.md");
    refuse(input, extension.empty() ? "the name has no extension" : in_quotes(extension) + " files are no studies",
           kStudy);
}

}  // namespace treefarm
