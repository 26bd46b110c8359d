// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/inflater.h"

#include <zlib.h>

#include <algorithm>
#include <array>

#include "common/base/error.h"

namespace treefarm {

struct Inflater::State {
    z_stream stream{};
    std::array<unsigned char, 65536> input;
    bool ended = false;
};

Inflater::Inflater(std::istream& in, std::uint64_t packed_size, std::string name)
    : state_(std::make_unique<State>()), in_(in), packed_left_(packed_size), name_(std::move(name)) {
    if (inflateInit(&state_->stream) != Z_OK) throw RunError("zlib cannot start");
}

Inflater::~Inflater() {
    inflateEnd(&state_->stream);
}

std::uint64_t Inflater::most_left() const {
    // 64 KiB: input that zlib may have consumed without output so far.
    return (packed_left_ + state_->stream.avail_in) * 1032 + 65536;
}

void Inflater::refuse(const std::string& what, const std::string& cure) const {
    throw InputError(Location{name_}, what + " (at byte " + std::to_string(unpacked_) + " of the unpacked mesh)", cure);
}

std::size_t Inflater::unpack(void* target, std::size_t size) {
    z_stream& stream = state_->stream;
    std::size_t done = 0;
    while (done < size && !state_->ended) {
        if (stream.avail_in == 0 && packed_left_ > 0) {
            const std::uint64_t wanted = std::min<std::uint64_t>(packed_left_, state_->input.size());
            in_.read(reinterpret_cast<char*>(state_->input.data()), static_cast<std::streamsize>(wanted));
            if (in_.gcount() != static_cast<std::streamsize>(wanted)) refuse("the file cannot be read", "try again");
            packed_left_ -= wanted;
            stream.next_in = state_->input.data();
            stream.avail_in = static_cast<uInt>(wanted);
        }
        const std::size_t piece = std::min<std::size_t>(size - done, std::size_t{1} << 30);
        stream.next_out = static_cast<Bytef*>(target) + done;
        stream.avail_out = static_cast<uInt>(piece);
        const int status = inflate(&stream, Z_NO_FLUSH);
        const std::size_t got = piece - stream.avail_out;
        done += got;
        unpacked_ += got;
        if (status == Z_STREAM_END)
            state_->ended = true;
        else if (status == Z_BUF_ERROR && stream.avail_in == 0 && packed_left_ == 0)
            refuse("the packed data end too early", "the file is cut short: repair it");
        else if (status != Z_OK)
            refuse("the packed data are damaged", "repair the file");
    }
    return done;
}

void Inflater::read(void* target, std::size_t size) {
    if (unpack(target, size) < size)
        refuse("the mesh has fewer values than its header says", "the file is cut short or damaged: repair it");
}

void Inflater::finish() {
    unsigned char more = 0;
    if (unpack(&more, 1) > 0) refuse("the mesh has more values than its header says", "repair the file");
}

}  // namespace treefarm
