// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/guiding/any_guide.h"

namespace treefarm {

/// A model as stored in a run directory's tree.bin.
struct StoredModel {
    AnyModel model;
    std::string hash;  ///< hash of the file's bytes, as in summary.json
    std::uint64_t bytes = 0;
};

/// Reads the file. Throws InputError if it is unreadable, its hash differs from `expected_hash` (empty: any;
/// `otherwise`: the meaning of a difference), or it holds no model.
StoredModel read_model(const std::filesystem::path& file, const std::string& expected_hash,
                       const std::string& otherwise);

}  // namespace treefarm
