// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/base/error.h"

namespace treefarm::test {

/// A document after a cure, by one way that the cure names.
struct Cured {
    std::string step;      ///< what was done
    std::string document;  ///< the document after it
};

/// Does to a document of XML what the cure of an error about it says, wherever that takes no thought: another word for
/// the one in quotes, a number within the limits that it names, an element away, an element added. Nothing for cures
/// that leave something to the reader ("check the path").
std::vector<Cured> apply_cure(const std::string& document, const InputError& error);

/// Whether apply_cure understands a cure, or the beginning of one.
bool is_mechanical(const std::string& cure);

/// A refusal in the program's source.
struct Refusal {
    std::string where;               ///< file:line
    std::vector<std::string> cures;  ///< the texts in quotes from which its cure is made
};

/// Every InputError that is thrown and every call of `unsupported` in the C++ files of a folder of the source.
std::vector<Refusal> refusals_in(const std::string& folder);

}  // namespace treefarm::test
