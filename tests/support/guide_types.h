// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cctype>
#include <string>
#include <vector>

#include "common/config/job_keys.h"

namespace treefarm::test {

/// Values of guiding.type that guide, from the key's documentation.
inline std::vector<std::string> guide_types() {
    const JobKey& key = *find_job_key("guiding.type");
    std::vector<std::string> types;
    std::string word;
    for (const char c : key.range + " ") {
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
            word += c;
            continue;
        }
        Job job;
        if (!word.empty() && key.parse(job, word) && job.guiding.type != GuidingType::none) types.push_back(word);
        word.clear();
    }
    return types;
}

}  // namespace treefarm::test
