// SPDX-License-Identifier: Apache-2.0
#include "report/study_report.h"

#include "common/base/files/atomic_file.h"
#include "report/processor_fraction.h"
#include "report/study_csv.h"
#include "report/study_page.h"
#include "report/verdict.h"

namespace treefarm {

namespace {

void write_text(const std::filesystem::path& path, const std::string& text) {
    write_file_atomically(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

WrittenReport written(const StudyResults& results, const std::filesystem::path& file) {
    return {file, answers(results, main_clock(results)), busy_warning(results)};
}

}  // namespace

WrittenReport write_page(const StudyResults& results, const std::filesystem::path& file) {
    const std::string page = study_page(results);
    write_output_file(file, {reinterpret_cast<const std::uint8_t*>(page.data()), page.size()});
    return written(results, file);
}

WrittenReport write_study_report(const std::filesystem::path& folder) {
    const StudyResults results = read_study_results(folder);
    write_text(folder / "cells.csv", cells_csv(results));
    write_text(folder / "passes.csv", passes_csv(results));
    write_text(folder / "report.html", study_page(results));
    return written(results, folder / "report.html");
}

}  // namespace treefarm
