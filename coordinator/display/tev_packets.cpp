// SPDX-License-Identifier: Apache-2.0
#include "coordinator/display/tev_packets.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace treefarm {

namespace {

enum class Operation : std::uint8_t { create_image = 4, update_image_v3 = 6 };

constexpr std::array<char, 3> kChannels = {'R', 'G', 'B'};

class Packet {
  public:
    explicit Packet(Operation operation, const std::string& name) {
        writer_.put(std::uint32_t{0});  // placeholder of the length
        writer_.put(static_cast<std::uint8_t>(operation));
        writer_.put(std::uint8_t{0});  // do not select the image in the viewer
        put_text(name);
    }

    template <class T>
    void put(T value) {
        writer_.put(value);
    }
    void put_channels() { put(static_cast<std::int32_t>(kChannels.size())); }
    void put_channel_names() {
        for (const char name : kChannels)
            put_text(std::string(1, name));
    }
    void put_bytes(std::span<const std::uint8_t> bytes) { writer_.put_bytes(bytes); }
    void reserve(std::size_t more) { writer_.reserve(more); }

    Bytes take() {
        Bytes bytes = writer_.take();
        const auto length = static_cast<std::uint32_t>(bytes.size());
        std::memcpy(bytes.data(), &length, sizeof length);
        return bytes;
    }

  private:
    void put_text(const std::string& text) {
        // The protocol's texts end at the first zero byte.
        const std::string whole = text.substr(0, text.find('\0'));
        writer_.put_bytes({reinterpret_cast<const std::uint8_t*>(whole.c_str()), whole.size() + 1});
    }

    ByteWriter writer_;
};

}  // namespace

Bytes tev_create_image(const std::string& name, int width, int height) {
    Packet packet(Operation::create_image, name);
    packet.put(std::int32_t{width});
    packet.put(std::int32_t{height});
    packet.put_channels();
    packet.put_channel_names();
    return packet.take();
}

Bytes tev_update_rows(const std::string& name, const RgbImage& image, int first, int end) {
    static_assert(sizeof(Rgb) == 3 * sizeof(float), "pixels are sent as they lie");
    Packet packet(Operation::update_image_v3, name);
    packet.put_channels();
    packet.put_channel_names();
    for (const int field : {0, first, image.width, end - first})
        packet.put(std::int32_t{field});
    for (std::int64_t channel = 0; channel < std::ssize(kChannels); ++channel)
        packet.put(channel);  // offset of its first value
    for (std::size_t channel = 0; channel < kChannels.size(); ++channel)
        packet.put(static_cast<std::int64_t>(kChannels.size()));  // stride between pixels
    const auto width = static_cast<std::size_t>(image.width), rows = static_cast<std::size_t>(end - first);
    const auto pixels = std::span(image.pixels).subspan(static_cast<std::size_t>(first) * width, rows * width);
    packet.reserve(pixels.size_bytes());
    packet.put_bytes({reinterpret_cast<const std::uint8_t*>(pixels.data()), pixels.size_bytes()});
    return packet.take();
}

int tev_rows_per_packet(int width) {
    constexpr std::size_t kBytes = 256 * 1024;
    return static_cast<int>(std::max<std::size_t>(1, kBytes / (static_cast<std::size_t>(width) * sizeof(Rgb))));
}

}  // namespace treefarm
