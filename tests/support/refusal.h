// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/error.h"

namespace treefarm::test {

/// Message of the InputError that `act` throws; `accepted` if it throws none.
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
