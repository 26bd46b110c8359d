// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/base/error.h"

namespace treefarm::test {

/// A document after one of the steps that a cure names.
struct Cured {
    std::string step;      ///< the applied step
    std::string document;  ///< the resulting document
};

/// Applies the cure of an error to an XML document, if that needs no judgement: another word for the quoted one, a
/// number within the stated limits, an element removed, an element added. Empty for cures that need a person ("check
/// the path").
std::vector<Cured> apply_cure(const std::string& document, const InputError& error);

/// Whether apply_cure understands a cure, or the beginning of one.
bool is_mechanical(const std::string& cure);

/// An error thrown in the program's source.
struct Refusal {
    std::string where;               ///< file:line
    std::vector<std::string> cures;  ///< string literals of its cure
};

/// Every InputError thrown and every call of `unsupported` in the C++ files of a source folder.
std::vector<Refusal> refusals_in(const std::string& folder);

}  // namespace treefarm::test
