// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/error.h"

namespace treefarm::test {

/// The message of the InputError that an act ends with; `accepted` if it ends without.
template <class Act>
std::string refusal_of(const Act& act, const std::string& accepted = "") {
    try {
        act();
    } catch (const InputError& error) {
        return error.what();
    }
    return accepted;
}

}  // namespace treefarm::test
