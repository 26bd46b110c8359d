// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/base/text/parse_text.h"
#include "common/config/job_keys.h"

namespace treefarm {

inline constexpr std::int64_t kMaxInt = std::numeric_limits<int>::max();
inline constexpr std::int64_t kMaxSpp = std::int64_t{1} << 30;

/// Makers of job keys, by type of value. `member` returns a reference to the value in a job, const or not.

/// Key of an integer in [low, high] or, if given, equal to `also`.
template <class Member>
JobKey integer_key(const char* name, const char* range, const char* doc, Member member, std::int64_t low,
                   std::int64_t high, std::int64_t also) {
    return {name,
            ValueKind::integer,
            range,
            doc,
            [=](Job& job, const std::string& text) {
                const auto value = parse_integer(text);
                if (!value || ((*value < low || *value > high) && *value != also)) return false;
                member(job) = static_cast<std::decay_t<decltype(member(job))>>(*value);
                return true;
            },
            [=](const Job& job) { return std::to_string(member(job)); },
            {}};
}

template <class Member>
JobKey integer_key(const char* name, const char* range, const char* doc, Member member, std::int64_t low,
                   std::int64_t high) {
    return integer_key(name, range, doc, member, low, high, low);
}

/// Key of a number for which `in_range` holds; `read` parses it, with its unit.
template <class Member, class Check>
JobKey number_key(const char* name, const char* range, const char* doc, Member member, Check in_range,
                  std::optional<double> (*read)(std::string_view) = &parse_number) {
    return {name,
            read == &parse_number ? ValueKind::number : ValueKind::number_or_text,
            range,
            doc,
            [=](Job& job, const std::string& text) {
                const auto number = read(text);
                if (!number) return false;
                const auto value = static_cast<std::decay_t<decltype(member(job))>>(*number);
                if (!std::isfinite(value) || !in_range(value)) return false;
                member(job) = value;
                return true;
            },
            [=](const Job& job) { return number_text(member(job)); },
            {}};
}

template <class Member>
JobKey boolean_key(const char* name, const char* doc, Member member) {
    return {name,
            ValueKind::boolean,
            "true or false",
            doc,
            [=](Job& job, const std::string& text) {
                const auto value = parse_boolean(text);
                if (value) member(job) = *value;
                return value.has_value();
            },
            [=](const Job& job) { return std::string(member(job) ? "true" : "false"); },
            {}};
}

template <class Member>
JobKey text_key(const char* name, const char* doc, Member member) {
    return {name,
            ValueKind::text,
            "text",
            doc,
            [=](Job& job, const std::string& text) {
                member(job) = text;
                return text.find('\0') == std::string::npos;
            },
            [=](const Job& job) { return member(job); },
            {}};
}

/// Key of one of several words; `Value` is an enum or a std::string.
template <class Member, class Value>
JobKey word_key(const char* name, const char* doc, Member member, std::vector<std::pair<std::string, Value>> words,
                std::vector<UnavailableValue> unavailable = {}) {
    std::string range;
    for (const auto& [word, value] : words)
        range += (range.empty() ? "\"" : " or \"") + word + "\"";
    return {name,
            ValueKind::text,
            range,
            doc,
            [=](Job& job, const std::string& text) {
                for (const auto& [word, value] : words)
                    if (word == text) {
                        member(job) = value;
                        return true;
                    }
                return false;
            },
            [=](const Job& job) {
                for (const auto& [word, value] : words)
                    if (value == member(job)) return word;
                return std::string();
            },
            std::move(unavailable)};
}

/// Key of a Rule.
template <class Member>
JobKey rule_key(const char* name, const char* doc, Member member) {
    return word_key(name, doc, member,
                    std::vector<std::pair<std::string, Rule>>{
                        {"usual", Rule::usual}, {"always", Rule::always}, {"while_it_pays", Rule::while_it_pays}});
}

/// The keys of job_keys() that begin with "guiding.".
std::vector<JobKey> guiding_keys();

}  // namespace treefarm
