// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "common/base/error.h"

namespace treefarm::mitsuba {

/// Values of $name in a scene: from outside (-D name=value), otherwise from <default>.
class Parameters {
  public:
    explicit Parameters(const std::map<std::string, std::string>& defines);

    /// Adds a <default>; ignored if the name has a value already.
    void add_default(const std::string& name, const std::string& value, const Location& where);

    /// The text with every $name replaced; the longest matching name is used. An unknown name throws InputError.
    std::string substitute(const std::string& text, const Location& where);

    /// Throws InputError for a value from outside that the scene does not use, most likely a typing error.
    void require_all_used(const Location& scene) const;

  private:
    struct Parameter {
        std::string value;
        bool used = false;
    };
    std::map<std::string, Parameter> parameters_;
    std::size_t replaced_bytes_ = 0;  ///< of all texts with a $name
};

}  // namespace treefarm::mitsuba
