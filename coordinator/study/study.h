// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/config/setting.h"

namespace treefarm {

/// A scene of a study.
struct StudyScene {
    std::string name;
    std::string file;       ///< absolute
    std::string reference;  ///< absolute, an EXR file; empty: rendered
    Location where;         ///< of the file, for messages
    Location reference_where;
    std::vector<Setting> settings;  ///< job keys of its own
};

/// One of the methods that a study compares: a name and the job keys that make it what it is.
struct StudyMethod {
    std::string name;
    std::vector<Setting> settings;
};

/// How references are rendered for scenes that name none.
struct StudyReference {
    std::vector<Setting> settings;  ///< job keys, budget and seed among them
};

/// A matrix of methods, scenes and seeds (docs/use/studies.md).
struct Study {
    std::string file;
    std::string directory;             ///< absolute or relative to the current folder
    std::vector<Setting> job;          ///< keys of all cells
    std::vector<Setting> budgets;      ///< of one kind (time, samples or error); every method has a cell of each
    std::vector<StudyScene> scenes;    ///< in the file's order
    std::vector<StudyMethod> methods;  ///< with every combination of [vary]
    std::vector<std::uint64_t> seeds;
    std::string baseline;  ///< the method that others are held against
    int warmup = 1;        ///< cells per scene that are rendered first and thrown away
    StudyReference reference;
};

/// One render of a study.
struct StudyCell {
    std::size_t scene = 0, method = 0;  ///< indices
    std::uint64_t seed = 0;
    std::size_t repetition = 0;  ///< index of the seed
    std::size_t budget = 0;      ///< index
};

/// All cells in the order in which they run: scene by scene, within it seed by seed, budget by budget, within that all
/// methods. Each repetition begins with the next method, so that a machine that drifts, or a neighbour of a cell,
/// favours nobody.
std::vector<StudyCell> study_cells(const Study& study);

/// Reads a study file. Throws InputError with file:line:column.
Study read_study(const std::filesystem::path& path);

/// Reads TOML text as read_study() reads a file; files are relative to the folder of `path`.
Study parse_study(const std::string& toml, const std::filesystem::path& path);

}  // namespace treefarm
