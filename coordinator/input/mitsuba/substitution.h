// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "common/base/error.h"

namespace treefarm::mitsuba {

/// Values of $name in a scene: from outside (-D name=value), or, where those are silent, from <default>.
class Parameters {
  public:
    explicit Parameters(const std::map<std::string, std::string>& defines);

    /// Adds what <default> says; ignored if the name has a value already.
    void add_default(const std::string& name, const std::string& value, const Location& where);

    /// The text with every $name replaced; the longest name that fits is taken. An unknown name throws InputError.
    std::string substitute(const std::string& text, const Location& where);

    /// A value from outside that the scene never asked for is most likely a typing error: InputError.
    void require_all_used(const Location& scene) const;

  private:
    struct Parameter {
        std::string value;
        bool used = false;
    };
    std::map<std::string, Parameter> parameters_;
    std::size_t replaced_bytes_ = 0;  ///< of all texts that had a $name
};

}  // namespace treefarm::mitsuba
