// SPDX-License-Identifier: Apache-2.0
#include "common/base/text/printable.h"
#include "common/runs/run_json.h"
#include "coordinator/run/folder_content.h"
#include "coordinator/study/study_rules.h"

namespace treefarm {

namespace {

/// Name of the study file that study.json was made from; "" if unknown.
std::string study_file_name(const std::filesystem::path& folder) {
    return std::filesystem::path(text_in(read_run_json(folder / kStudyFile), "study")).filename().string();
}

}  // namespace

void check_study_folder(const std::filesystem::path& folder, const Study& study, bool overwrite) {
    const Location where{folder.string(), 0, 0};
    if (folder_content(folder) == FolderContent::render)
        throw InputError(where, "holds a render (" + render_words(folder) + "), which a study does not replace",
                         "name another folder with --dir");
    if (folder_content(folder) == FolderContent::shot)
        throw InputError(where, "holds a shot, which a study does not replace", "name another folder with --dir");
    const std::string there = study_file_name(folder), own = std::filesystem::path(study.file).filename().string();
    if (!there.empty() && there != own && !overwrite)
        throw InputError(where, "holds another study (" + printable(there) + ")",
                         "name another folder with --dir, or replace its description and reports with --overwrite");
}

}  // namespace treefarm
