// SPDX-License-Identifier: Apache-2.0
#include "common/image/jpeg_check.h"

#include <cstddef>

namespace treefarm {
namespace {

constexpr std::uint8_t kMarker = 0xff, kHuffmanTables = 0xc4, kEnd = 0xd9, kScan = 0xda;

class Walk {
  public:
    explicit Walk(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    const char* fault() const {
        std::size_t at = 2;
        // Segments up to the first scan: what lies inside of others than tables (thumbnails, profiles) does not count.
        for (;;) {
            while (at < bytes_.size() && bytes_[at] != kMarker)
                ++at;
            while (at < bytes_.size() && bytes_[at] == kMarker)
                ++at;
            if (at >= bytes_.size()) return "it is cut short";
            if (bytes_[at] == kScan) break;
            if (bytes_[at] == kHuffmanTables && !good_tables(at + 1)) return kBadTables;
            at += 1 + word(at + 1);
        }
        // Behind it a marker is one wherever it stands, unless the file is damaged.
        bool ended = false;
        for (; at + 1 < bytes_.size(); ++at) {
            if (bytes_[at] != kMarker) continue;
            ended = ended || bytes_[at + 1] == kEnd;
            if (bytes_[at + 1] == kHuffmanTables && !good_tables(at + 2)) return kBadTables;
        }
        return ended ? "" : "it is cut short";
    }

  private:
    static constexpr const char* kBadTables = "a Huffman table has more than 256 codes";

    std::size_t byte(std::size_t at) const { return at < bytes_.size() ? bytes_[at] : 0; }
    std::size_t word(std::size_t at) const { return byte(at) << 8 | byte(at + 1); }

    /// A segment of tables from its length on: each a byte, 16 numbers of codes and so many values.
    bool good_tables(std::size_t begin) const {
        std::size_t at = begin + 2;
        for (const std::size_t end = begin + word(begin); at < end;) {
            std::size_t codes = 0;
            for (std::size_t i = 1; i <= 16; ++i)
                codes += byte(at + i);
            if (codes > 256) return false;
            at += 17 + codes;
        }
        return true;
    }

    std::span<const std::uint8_t> bytes_;
};

}  // namespace

const char* jpeg_fault(std::span<const std::uint8_t> bytes) {
    return Walk(bytes).fault();
}

}  // namespace treefarm
