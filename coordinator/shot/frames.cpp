// SPDX-License-Identifier: Apache-2.0
#include "coordinator/shot/frames.h"

#include <algorithm>
#include <optional>
#include <set>

#include "common/base/text/parse_text.h"

namespace treefarm {

namespace {

constexpr const char* kCure = "write 1-24, 1-24x2 or 1,5,9-12";

/// Placeholder of a frame number in a text.
struct Mark {
    std::size_t begin = 0, size = 0;
    int width = 0;  ///< minimal number of digits
};

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// First %d or %0Nd, N from 1 to 9, at or after `from`.
std::optional<Mark> next_mark(std::string_view text, std::size_t from) {
    for (std::size_t at = text.find('%', from); at != std::string_view::npos; at = text.find('%', at + 1)) {
        const std::string_view rest = text.substr(at + 1);
        if (rest.starts_with("d")) return Mark{at, 2, 1};
        if (rest.size() >= 3 && rest[0] == '0' && rest[1] >= '1' && rest[1] <= '9' && rest[2] == 'd')
            return Mark{at, 4, rest[1] - '0'};
    }
    return std::nullopt;
}

/// First run of # at or after `from` in a file's own name: folders may be called "shot#2".
std::optional<Mark> next_hashes(std::string_view text, std::size_t from) {
    const std::size_t slash = text.rfind('/');
    const std::size_t begin = text.find('#', slash == std::string_view::npos ? from : std::max(from, slash));
    if (begin == std::string_view::npos) return std::nullopt;
    const std::size_t size = std::min(text.find_first_not_of('#', begin), text.size()) - begin;
    return Mark{begin, size, static_cast<int>(size)};
}

template <class Next, class Instead>
std::string replaced(std::string_view text, Next next, Instead instead) {
    std::string result;
    std::size_t at = 0;
    while (const std::optional<Mark> mark = next(text, at)) {
        result += text.substr(at, mark->begin - at);
        result += instead(*mark);
        at = mark->begin + mark->size;
    }
    return result + std::string(text.substr(at));
}

class FrameParser {
  public:
    FrameParser(std::string_view text, const Location& where) : text_(text), where_(where) {}

    std::vector<int> parse() {
        if (trim(text_).empty()) refuse("there are no frames", kCure);
        for (std::size_t begin = 0; begin <= text_.size();) {
            const std::size_t end = std::min(text_.find(',', begin), text_.size());
            add_range(trim(text_.substr(begin, end - begin)));
            begin = end + 1;
        }
        return std::move(frames_);
    }

  private:
    [[noreturn]] void refuse(const std::string& what, const std::string& cure) const {
        throw InputError(where_, what, cure);
    }

    int number(std::string_view word, std::string_view range, int least) const {
        const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), is_digit);
        const auto value = plain ? parse_integer(word) : std::nullopt;
        if (!plain)
            refuse(in_quotes(word) + " in " + in_quotes(range) + " is no frame number",
                   std::string(kCure) + "; frames are whole numbers from 0 on");
        if (!value || *value > kLastFrame)
            refuse("frame " + std::string(word.substr(0, 20)) + " is above " + std::to_string(kLastFrame),
                   "number frames from 0 on");
        if (*value < least) refuse("a step of 0 in " + in_quotes(range), "write 1-24x2 for every second frame");
        return static_cast<int>(*value);
    }

    void add_range(std::string_view range) {
        if (range.empty()) refuse("a frame is missing between commas in " + in_quotes(text_), kCure);
        if (range[0] == '-' && range.size() > 1 && is_digit(range[1]))
            refuse(in_quotes(range) + " is no frame number, but negative",
                   "number frames from 0 on: shift them, and the scene by a -D of its own");
        const std::size_t dash = range.find('-'), times = range.find('x');
        if (times != std::string_view::npos && (dash == std::string_view::npos || times < dash))
            refuse("a step without a range in " + in_quotes(range), "write 1-24x2 for every second frame");
        const int first = number(trim(range.substr(0, dash)), range, 0);
        int last = first, step = 1;
        if (dash != std::string_view::npos) {
            last = number(trim(range.substr(dash + 1, std::min(times, range.size()) - dash - 1)), range, 0);
            if (times != std::string_view::npos) step = number(trim(range.substr(times + 1)), range, 1);
        }
        if (last < first)
            refuse("the range " + in_quotes(range) + " ends before it begins",
                   "write " + std::to_string(last) + "-" + std::to_string(first));
        for (int frame = first; frame <= last; frame += step) {
            if (!seen_.insert(frame).second) continue;
            if (frames_.size() >= static_cast<std::size_t>(kMostFrames))
                refuse("more than " + std::to_string(kMostFrames) + " frames", "render them in several shots");
            frames_.push_back(frame);
        }
    }

    const std::string_view text_;
    const Location& where_;
    std::vector<int> frames_;
    std::set<int> seen_;
};

}  // namespace

std::vector<int> parse_frames(std::string_view text, const Location& where) {
    return FrameParser(text, where).parse();
}

bool names_frame(std::string_view text) {
    return next_mark(text, 0).has_value();
}

std::string for_frame(std::string_view text, int frame) {
    return replaced(text, next_mark, [&](const Mark& mark) { return frame_digits(frame, mark.width); });
}

bool output_names_frame(std::string_view file) {
    return names_frame(file) || next_hashes(file, 0).has_value();
}

std::string output_for_frame(std::string_view file, int frame) {
    return replaced(for_frame(file, frame), next_hashes,
                    [&](const Mark& mark) { return frame_digits(frame, mark.width); });
}

std::string name_without_frame(std::string_view name) {
    std::string plain = replaced(name, next_mark, [](const Mark&) { return std::string(); });
    const auto divides = [](char c) { return c == '.' || c == '-' || c == '_'; };
    while (!plain.empty() && divides(plain.back()))
        plain.pop_back();
    return plain;
}

std::string frame_digits(int frame, int width) {
    const std::string digits = std::to_string(frame);
    return std::string(static_cast<std::size_t>(std::max(0, width - static_cast<int>(digits.size()))), '0') + digits;
}

}  // namespace treefarm
