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

}  // namespace

WrittenReport write_page(const StudyResults& results, const std::filesystem::path& file) {
    write_text(file, study_page(results));
    return {file, answers(results, main_clock(results)), busy_warning(results)};
}

WrittenReport write_study_report(const std::filesystem::path& folder) {
    const StudyResults results = read_study_results(folder);
    write_text(folder / "cells.csv", cells_csv(results));
    write_text(folder / "passes.csv", passes_csv(results));
    return write_page(results, folder / "report.html");
}

}  // namespace treefarm
