// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string>

namespace treefarm {

/// Unpacks a zlib stream piece by piece, so that nothing is allocated for what the stream does not hold.
class Inflater {
  public:
    /// The packed bytes are the next `packed_size` bytes of `in`, or fewer: the stream knows its end. `name` begins
    /// every message.
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

    /// Checks that everything has been read and that the checksum is right; throws InputError.
    void finish();

    std::uint64_t unpacked() const { return unpacked_; }
    /// No more than this can still come out, whatever a header claims: deflate packs 1032 bytes into one at best
    /// (zlib's technical notes).
    std::uint64_t most_left() const;

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
