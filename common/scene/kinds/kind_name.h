// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cxxabi.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <typeinfo>

namespace treefarm {

/// Name of a kind's type: "RoughDiffuseMaterial".
template <class Kind>
std::string kind_name() {
    int failed = 0;
    const std::unique_ptr<char, decltype(&std::free)> name(
        abi::__cxa_demangle(typeid(Kind).name(), nullptr, nullptr, &failed), &std::free);
    const std::string text = failed == 0 ? name.get() : typeid(Kind).name();
    const std::size_t colon = text.rfind(':');
    return colon == std::string::npos ? text : text.substr(colon + 1);
}

}  // namespace treefarm
