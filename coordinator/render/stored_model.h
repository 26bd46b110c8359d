// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/guiding/any_guide.h"

namespace treefarm {

/// A model as a run directory's tree.bin holds it.
struct StoredModel {
    AnyModel model;
    std::string hash;  ///< of the file's bytes, as summary.json has it
    std::uint64_t bytes = 0;
};

/// Reads the file. Throws InputError where it cannot be read, or its hash is not `expected_hash` (`otherwise` says what
/// that means; an empty hash expects nothing), or it holds no model.
StoredModel read_model(const std::filesystem::path& file, const std::string& expected_hash,
                       const std::string& otherwise);

}  // namespace treefarm
