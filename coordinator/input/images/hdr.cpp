// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/images/hdr.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace treefarm {
namespace {

constexpr std::array<std::string_view, 2> kMagics = {"#?RADIANCE\n", "#?RGBE\n"};
constexpr int kLongestCodedLine = 32767;

std::string_view as_text(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Parses the resolution line, "-Y 480 +X 640".
bool parse_size(std::string_view line, HdrHeader& header) {
    const auto take = [&](std::string_view word, int& number) {
        if (!line.starts_with(word)) return false;
        line.remove_prefix(word.size());
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
        if (error != std::errc() || number < 1) return false;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
        return true;
    };
    return take("-Y ", header.height) && take(" +X ", header.width) && line.empty();
}

class HdrDecoder {
  public:
    HdrDecoder(std::span<const std::uint8_t> data, std::size_t width) : data_(data), line_(width * 4) {}

    /// The next scan line, four bytes per pixel; nullptr, with the reason in `why`, if it is malformed.
    const std::vector<std::uint8_t>* next(std::string& why) {
        const bool done = begins_coded() ? decode_line(why) : copy_line(why);
        return done ? &line_ : nullptr;
    }

  private:
    std::size_t width() const { return line_.size() / 4; }

    /// Whether the line is run-length encoded: it then begins with 2, 2 and its length, which no pixel does.
    bool begins_coded() const {
        const std::size_t w = width();
        return w >= 8 && w <= kLongestCodedLine && data_.size() >= 4 && data_[0] == 2 && data_[1] == 2 &&
               (data_[2] & 0x80) == 0;
    }

    bool copy_line(std::string& why) {
        // A mantissa of a pixel that is not black is above 127: 1, 1, 1 stands for repetitions of the previous pixel.
        for (std::size_t at = 0; at < line_.size() && at + 3 < data_.size(); at += 4)
            if (data_[at] == 1 && data_[at + 1] == 1 && data_[at + 2] == 1) return refuse(why, kOldHdrRuns);
        if (data_.size() < line_.size()) return refuse(why, "it is cut short");
        line_.assign(data_.begin(), data_.begin() + static_cast<std::ptrdiff_t>(line_.size()));
        data_ = data_.subspan(line_.size());
        return true;
    }

    bool decode_line(std::string& why) {
        if ((std::size_t{data_[2]} << 8 | data_[3]) != width()) return refuse(why, "a line has another length");
        data_ = data_.subspan(4);
        for (std::size_t plane = 0; plane < 4; ++plane)
            for (std::size_t x = 0; x < width();) {
                if (data_.empty()) return refuse(why, "it is cut short");
                const bool run = data_[0] > 128;
                const std::size_t count = run ? data_[0] - 128u : data_[0];
                if (count == 0 || count > width() - x) return refuse(why, "a run does not fit into its line");
                const std::size_t size = 1 + (run ? 1 : count);
                if (data_.size() < size) return refuse(why, "it is cut short");
                for (std::size_t i = 0; i < count; ++i)
                    line_[4 * x++ + plane] = data_[run ? 1 : 1 + i];
                data_ = data_.subspan(size);
            }
        return true;
    }

    static bool refuse(std::string& why, const char* reason) {
        why = reason;
        return false;
    }

    std::span<const std::uint8_t> data_;
    std::vector<std::uint8_t> line_;
};

}  // namespace

bool is_hdr(std::span<const std::uint8_t> bytes) {
    for (const std::string_view magic : kMagics)
        if (as_text(bytes).starts_with(magic)) return true;
    return false;
}

std::optional<HdrHeader> read_hdr_header(std::span<const std::uint8_t> bytes, std::string& why) {
    const std::string_view text = as_text(bytes);
    bool rgbe = false;
    std::size_t at = 0;
    const auto next_line = [&]() -> std::optional<std::string_view> {
        const std::size_t end = text.find('\n', at);
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view line = text.substr(at, end - at);
        at = end + 1;
        return line;
    };
    std::optional<std::string_view> line = next_line();
    for (; line && !line->empty(); line = next_line())
        rgbe = rgbe || *line == "FORMAT=32-bit_rle_rgbe";
    HdrHeader header;
    if (line) line = next_line();
    why = !line                        ? "its header is cut short"
          : !rgbe                      ? "its colours are not RGBE"
          : !parse_size(*line, header) ? "its size is malformed, or its rows do not run from the top and the left"
                                       : "";
    header.data_begin = at;
    return why.empty() ? std::optional(header) : std::nullopt;
}

std::optional<std::vector<float>> decode_hdr(std::span<const std::uint8_t> bytes, const HdrHeader& header,
                                             std::string& why) {
    const auto width = static_cast<std::size_t>(header.width), height = static_cast<std::size_t>(header.height);
    HdrDecoder decoder(bytes.subspan(header.data_begin), width);
    std::vector<float> values;
    values.reserve(3 * width * height);
    for (std::size_t y = 0; y < height; ++y) {
        const std::vector<std::uint8_t>* line = decoder.next(why);
        if (line == nullptr) return std::nullopt;
        for (std::size_t x = 0; x < width; ++x) {
            const std::uint8_t* pixel = line->data() + 4 * x;
            const float unit = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f, pixel[3] - 136);
            for (int c = 0; c < 3; ++c)
                values.push_back(static_cast<float>(pixel[c]) * unit);
        }
    }
    return values;
}

}  // namespace treefarm
