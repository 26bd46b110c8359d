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
    std::string reference;  ///< absolute, an EXR file; empty: to be rendered
    Location where;         ///< of the file, for messages
    Location reference_where;
    std::vector<Setting> settings;  ///< job keys for this scene
};

/// A method that a study compares: a name and its job keys.
struct StudyMethod {
    std::string name;
    std::vector<Setting> settings;
};

/// Settings for rendering the references of scenes without one.
struct StudyReference {
    std::vector<Setting> settings;  ///< job keys, budget and seed included
};

/// A matrix of methods, scenes and seeds (docs/use/studies.md).
struct Study {
    std::string file;
    std::string directory;           ///< absolute or relative to the current folder
    std::vector<Setting> job;        ///< keys of all cells
    std::vector<Setting> budgets;    ///< budgets of one kind (time, samples or error); each method has a cell for each
    std::vector<StudyScene> scenes;  ///< scenes in the file's order
    std::vector<StudyMethod> methods;  ///< methods with every combination of [vary]
    std::vector<std::uint64_t> seeds;
    std::string baseline;  ///< method to which others are compared
    int warmup = 1;        ///< cells per scene that are rendered first and discarded
    StudyReference reference;
};

/// A render of a study.
struct StudyCell {
    std::size_t scene = 0, method = 0;  ///< indices
    std::uint64_t seed = 0;
    std::size_t repetition = 0;  ///< index of the seed
    std::size_t budget = 0;      ///< index
};

/// All cells in the order of execution: scene by scene, in it seed by seed, budget by budget, and within that all
/// methods. Each repetition begins with the next method, so that no method gains from a machine that slows down, or
/// from its neighbours.
std::vector<StudyCell> study_cells(const Study& study);

/// Reads a study file. Throws InputError with file:line:column.
Study read_study(const std::filesystem::path& path);

/// Reads TOML text as read_study() reads a file; file names are relative to the folder of `path`.
Study parse_study(const std::string& toml, const std::filesystem::path& path);

}  // namespace treefarm
