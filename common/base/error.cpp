// SPDX-License-Identifier: Apache-2.0
#include "common/base/error.h"

namespace treefarm {

std::string Location::text() const {
    std::string text = file;
    if (line > 0) {
        text += (text.empty() ? "" : ":") + std::to_string(line);
        if (column > 0) text += ":" + std::to_string(column);
    }
    return text;
}

static std::string join(const Location& where, const std::string& what, const std::string& cure) {
    const std::string location = where.text();
    return (location.empty() ? "" : location + ": ") + what + (cure.empty() ? "" : "; " + cure);
}

InputError::InputError(const Location& where, const std::string& what, const std::string& cure)
    : std::runtime_error(join(where, what, cure)), where_(where), problem_(what), cure_(cure) {}

}  // namespace treefarm
