// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string>

namespace treefarm {

/// Unpacks a zlib stream in pieces, so that memory grows only with data that exist.
class Inflater {
  public:
    /// `packed_size`: upper bound of the packed bytes in `in`; the stream knows its end. `name` begins all messages.
    Inflater(std::istream& in, std::uint64_t packed_size, std::string name);
    ~Inflater();
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    /// Unpacks exactly `size` bytes. Throws InputError if the stream ends before, or is damaged.
    void read(void* target, std::size_t size);
    template <class T>
    T get() {
        T value;
        read(&value, sizeof(T));
        return value;
    }

    /// Checks that all has been read and the checksum is right. Throws InputError.
    void finish();

    std::uint64_t unpacked() const { return unpacked_; }
    /// Upper bound of the bytes still to be unpacked: deflate packs at most 1032 bytes into one (zlib's technical
    /// notes).
    std::uint64_t most_left() const;

    /// Upper bound of the packed bytes that have not been read.
    std::uint64_t packed_left() const { return packed_left_; }

    [[noreturn]] void refuse(const std::string& what, const std::string& cure) const;

  private:
    struct State;
    /// Unpacks up to `size` bytes; fewer at the end of the stream.
    std::size_t unpack(void* target, std::size_t size);

    std::unique_ptr<State> state_;
    std::istream& in_;
    std::uint64_t packed_left_, unpacked_ = 0;
    std::string name_;
};

}  // namespace treefarm
