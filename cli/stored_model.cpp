// SPDX-License-Identifier: Apache-2.0
#include "cli/stored_model.h"

#include "cli/refuse.h"
#include "common/base/files/read_bytes.h"
#include "common/base/hash.h"

namespace treefarm {

StoredModel read_model(const std::filesystem::path& file, const std::string& expected_hash,
                       const std::string& otherwise) {
    constexpr const char* kCure = "render again";
    const std::vector<std::uint8_t> bytes = read_bytes(file, kCure);
    StoredModel stored;
    stored.hash = hash_text(hash_bytes(bytes));
    stored.bytes = bytes.size();
    if (!expected_hash.empty() && stored.hash != expected_hash) refuse(file, otherwise, kCure);
    try {
        stored.model = AnyModel::decode(bytes);
    } catch (const FormatError& error) {
        refuse(file, error.what(), kCure);
    }
    return stored;
}

}  // namespace treefarm
