// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/images/netpbm.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <string_view>

namespace treefarm {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// Tokenizer of a header, which skips comments.
class Words {
  public:
    explicit Words(std::string_view text) : text_(text) {}

    std::string_view next() {
        while (at_ < text_.size() && (is_blank(text_[at_]) || text_[at_] == '#'))
            at_ = text_[at_] == '#' ? std::min(text_.find('\n', at_), text_.size()) : at_ + 1;
        const std::size_t begin = at_;
        while (at_ < text_.size() && !is_blank(text_[at_]))
            ++at_;
        return text_.substr(begin, at_ - begin);
    }

    /// The next word as a number; false if it is none.
    template <class Number>
    bool next(Number& number) {
        const std::string_view word = next();
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        return error == std::errc() && end == word.data() + word.size();
    }

    std::size_t at() const { return at_; }

  private:
    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace

std::uint64_t NetpbmHeader::data_size() const {
    const std::uint64_t bytes = floats ? 4 : max_value > 255 ? 2 : 1;
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
           static_cast<std::uint64_t>(channels) * bytes;
}

bool is_netpbm(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= 3 && bytes[0] == 'P' && std::string_view("123456fF").find(static_cast<char>(bytes[1])) < 8 &&
           is_blank(static_cast<char>(bytes[2]));
}

std::optional<NetpbmHeader> read_netpbm_header(std::span<const std::uint8_t> bytes, std::string& why) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const char kind = text[1];
    NetpbmHeader header;
    header.channels = kind == '6' || kind == 'F' ? 3 : 1;
    header.floats = kind == 'f' || kind == 'F';
    if (!header.floats && kind != '5' && kind != '6') {
        why = "it is a plain-text or black-and-white kind of PNM, of which only P5 and P6 are read";
        return std::nullopt;
    }
    Words words(text.substr(2));
    const bool sized = words.next(header.width) && words.next(header.height) && header.width > 0 && header.height > 0;
    const bool scaled = header.floats
                            ? words.next(header.scale) && std::isfinite(header.scale) && header.scale != 0.0
                            : words.next(header.max_value) && header.max_value > 0 && header.max_value <= 65535;
    header.data_begin = 2 + words.at() + 1;
    if (!sized || !scaled)
        why = "its header is malformed";
    else if (header.data_begin > bytes.size() || header.data_size() > bytes.size() - header.data_begin)
        why = "it is cut short";
    return why.empty() ? std::optional(header) : std::nullopt;
}

std::vector<std::uint8_t> netpbm_bytes(std::span<const std::uint8_t> bytes, const NetpbmHeader& header) {
    const auto data = bytes.subspan(header.data_begin, static_cast<std::size_t>(header.data_size()));
    std::vector<std::uint8_t> values(data.begin(), data.end());
    const int max = header.max_value;
    if (max != 255)
        for (std::uint8_t& value : values)
            value = static_cast<std::uint8_t>((std::min<int>(value, max) * 255 + max / 2) / max);
    return values;
}

std::vector<float> netpbm_floats(std::span<const std::uint8_t> bytes, const NetpbmHeader& header) {
    const auto data = bytes.subspan(header.data_begin, static_cast<std::size_t>(header.data_size()));
    std::vector<float> values;
    if (!header.floats) {
        values.reserve(data.size() / 2);
        for (std::size_t i = 0; i + 1 < data.size(); i += 2)
            values.push_back(
                std::min(1.0f, static_cast<float>(data[i] << 8 | data[i + 1]) / static_cast<float>(header.max_value)));
        return values;
    }
    // Rows run from the bottom to the top.
    const auto row = static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.channels);
    const auto factor = static_cast<float>(std::abs(header.scale));
    values.reserve(data.size() / 4);
    for (auto y = static_cast<std::size_t>(header.height); y-- > 0;)
        for (std::size_t i = 4 * y * row; i < 4 * (y + 1) * row; i += 4) {
            std::uint32_t bits = 0;
            for (std::size_t k = 0; k < 4; ++k)
                bits = bits << 8 | data[i + (header.scale < 0.0 ? 3 - k : k)];
            values.push_back(std::bit_cast<float>(bits) * factor);
        }
    return values;
}

}  // namespace treefarm
