// SPDX-License-Identifier: Apache-2.0
// A render's images in a viewer: the stream is read by a small tev that takes nothing but its protocol.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/base/bytes.h"
#include "common/base/timer.h"
#include "coordinator/display/display_client.h"
#include "coordinator/display/tev_packets.h"

namespace treefarm {
namespace {

/// Images as a viewer holds them, by a strict reading of each packet. Throws std::runtime_error or FormatError.
class TinyTev {
  public:
    struct Picture {
        int width = 0, height = 0;
        std::vector<float> values;  ///< R, G, B
        std::vector<bool> known;
    };

    void take(std::span<const std::uint8_t> packet) {
        ByteReader reader(packet);
        require(reader.get<std::uint32_t>() == packet.size(), "the length of the whole packet");
        const auto operation = reader.get<std::uint8_t>();
        require(reader.get<std::uint8_t>() == 0, "an image that does not grab the focus");
        name = text(reader);
        if (operation == 4)
            create(reader);
        else if (operation == 6)
            update(reader);
        else
            require(false, "a known operation");
        require(reader.remaining() == 0, "nothing behind the last field");
    }

    std::string name;
    Picture picture;
    int created = 0;

  private:
    static void require(bool truth, const char* what) {
        if (!truth) throw std::runtime_error(std::string("no ") + what);
    }
    static std::string text(ByteReader& reader) {
        std::string found;
        for (char c = reader.get<char>(); c != '\0'; c = reader.get<char>())
            found += c;
        return found;
    }
    static void channels(ByteReader& reader) {
        require(reader.get<std::int32_t>() == 3, "three channels");
        for (const char* channel : {"R", "G", "B"})
            require(text(reader) == channel, "channels R, G, B");
    }
    void create(ByteReader& reader) {
        ++created;
        picture.width = reader.get<std::int32_t>();
        picture.height = reader.get<std::int32_t>();
        require(picture.width > 0 && picture.height > 0, "size");
        picture.values.assign(3u * static_cast<std::size_t>(picture.width * picture.height), 0.0f);
        picture.known.assign(static_cast<std::size_t>(picture.width * picture.height), false);
        channels(reader);
    }
    void update(ByteReader& reader) {
        require(created > 0, "image that was made before");
        channels(reader);
        const int x = reader.get<std::int32_t>(), y = reader.get<std::int32_t>();
        const int width = reader.get<std::int32_t>(), height = reader.get<std::int32_t>();
        require(
            x >= 0 && y >= 0 && width > 0 && height > 0 && x + width <= picture.width && y + height <= picture.height,
            "rectangle within the image");
        std::int64_t offsets[3], strides[3];
        for (std::int64_t& offset : offsets)
            offset = reader.get<std::int64_t>();
        for (std::int64_t& stride : strides)
            stride = reader.get<std::int64_t>();
        std::vector<float> data(reader.remaining() / sizeof(float));
        for (float& value : data)
            value = reader.get<float>();
        const std::int64_t pixels = std::int64_t{width} * height;
        std::int64_t size = 0;
        for (int c = 0; c < 3; ++c)
            size = std::max(size, offsets[c] + (pixels - 1) * strides[c] + 1);
        require(std::ssize(data) == size, "as many values as the strides ask for");
        for (std::int64_t p = 0; p < pixels; ++p) {
            const auto at = static_cast<std::size_t>((y + p / width) * picture.width + x + p % width);
            picture.known[at] = true;
            for (int c = 0; c < 3; ++c)
                picture.values[3 * at + static_cast<std::size_t>(c)] =
                    data[static_cast<std::size_t>(offsets[c] + p * strides[c])];
        }
    }
};

/// A port of this machine on which a viewer listens, or one that never takes what is sent.
class Viewer {
  public:
    explicit Viewer(bool reads) : listening_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        EXPECT_EQ(::bind(listening_, reinterpret_cast<sockaddr*>(&address), size), 0);
        EXPECT_EQ(::listen(listening_, 4), 0);
        ::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size);
        port = ntohs(address.sin_port);
        if (reads) thread_ = std::thread([this] { serve(); });
    }
    ~Viewer() {
        ending_ = true;
        if (thread_.joinable()) thread_.join();
        ::close(listening_);
    }

    DisplayServer server() const { return {"127.0.0.1", static_cast<std::uint16_t>(port)}; }
    /// Waits until the viewer's picture fulfils a condition.
    template <class Condition>
    bool wait_for(Condition condition) {
        const Timer timer;
        while (timer.seconds() < 20) {
            {
                const std::lock_guard lock(mutex);
                if (!wrong.empty() || condition(tev)) return wrong.empty();
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    }

    int port = 0;
    std::mutex mutex;
    TinyTev tev;
    std::string wrong;

  private:
    bool has_news(int socket) const {
        pollfd ready{socket, POLLIN, 0};
        while (!ending_)
            if (::poll(&ready, 1, 20) > 0) return true;
        return false;
    }
    void serve() {
        while (has_news(listening_)) {
            const int socket = ::accept(listening_, nullptr, nullptr);
            Bytes waiting;
            while (has_news(socket)) {
                std::uint8_t part[5000];
                const ssize_t got = ::recv(socket, part, sizeof part, 0);
                if (got <= 0) break;
                waiting.insert(waiting.end(), part, part + got);
                take_whole(waiting);
            }
            ::close(socket);
        }
    }
    void take_whole(Bytes& waiting) {
        while (waiting.size() >= 4) {
            std::uint32_t length = 0;
            std::memcpy(&length, waiting.data(), 4);
            if (waiting.size() < length && length < (1u << 20)) return;
            const std::lock_guard lock(mutex);
            try {
                if (length < 6 || length > (1u << 20)) throw std::runtime_error("no sensible length");
                tev.take(std::span(waiting).first(length));
            } catch (const std::exception& error) {
                wrong = error.what();
                return;
            }
            waiting.erase(waiting.begin(), waiting.begin() + length);
        }
    }

    int listening_;
    std::atomic<bool> ending_ = false;
    std::thread thread_;
};

/// An image of which each value is told from the others.
RgbImage ramp(int width, int height, float from) {
    RgbImage image(width, height);
    for (std::size_t p = 0; p < image.pixels.size(); ++p)
        image.pixels[p] = Rgb(from + static_cast<float>(p), from - static_cast<float>(p), 0.5f * from);
    return image;
}

bool shows(const TinyTev& tev, const RgbImage& image) {
    const std::size_t count = image.pixels.size();
    if (tev.picture.width != image.width || tev.picture.known.size() != count) return false;
    for (std::size_t p = 0; p < count; ++p)
        for (int c = 0; c < 3; ++c)
            if (!tev.picture.known[p] || tev.picture.values[3 * p + static_cast<std::size_t>(c)] != image.pixels[p][c])
                return false;
    return true;
}

TEST(Display, AViewerShowsTheImage) {
    Viewer viewer(true);
    DisplayClient client(viewer.server(), "a run");
    const RgbImage first = ramp(300, 250, 1.0f), second = ramp(300, 250, 7.0f), smaller = ramp(5, 3, 2.0f);
    for (const RgbImage* image : {&first, &second, &smaller}) {
        client.show([image] { return *image; });
        EXPECT_TRUE(viewer.wait_for([&](const TinyTev& tev) { return shows(tev, *image); })) << viewer.wrong;
    }
    EXPECT_EQ(viewer.tev.name, "a run");
    EXPECT_EQ(viewer.tev.created, 2) << "a new one for the new size alone";
    EXPECT_TRUE(client.take_news().empty());
}

TEST(Display, TheLastImageArrivesBeforeTheEnd) {
    Viewer viewer(true);
    const RgbImage image = ramp(64, 64, 3.0f);
    {
        DisplayClient client(viewer.server(), "a run", {2.0, 10.0, 10.0, 20.0});
        client.show([&] { return image; });
    }
    EXPECT_TRUE(viewer.wait_for([&](const TinyTev& tev) { return shows(tev, image); })) << viewer.wrong;
}

TEST(Display, AnAbsentViewerIsOneWarning) {
    DisplayServer nobody;
    {
        Viewer viewer(false);
        nobody = viewer.server();
    }
    DisplayClient client(nobody, "a run", {0.2, 0.2, 0.01, 0.2});
    std::atomic<int> tries = 0;
    std::vector<std::string> news;
    const Timer timer;
    while (tries < 5 && timer.seconds() < 20) {
        client.show([&] {
            ++tries;
            return ramp(4, 4, 1.0f);
        });
        for (std::string& one : client.take_news())
            news.push_back(std::move(one));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_GE(tries, 5);
    ASSERT_EQ(news.size(), 1u);
    EXPECT_NE(news[0].find(nobody.text()), std::string::npos) << news[0];
}

TEST(Display, AViewerThatTakesNothingKeepsNobodyWaiting) {
    Viewer viewer(false);
    std::atomic<int> made = 0;
    {
        DisplayClient client(viewer.server(), "a run", {1000, 1000, 1000, 0.05});
        for (int k = 0; k < 1000; ++k)
            client.show([&made] {
                ++made;
                return RgbImage(2000, 2000);
            });
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }  // would hang for 1000 seconds
    EXPECT_LE(made, 2) << "of images that wait only the newest is made";
}

TEST(Display, AServerIsNamedByHostAndPort) {
    EXPECT_EQ(parse_display_server("localhost:14158").host, "localhost");
    EXPECT_EQ(parse_display_server("[::1]:14158").host, "::1");
    EXPECT_EQ(parse_display_server("[::1]:14158").text(), "[::1]:14158");
    for (const char* wrong : {"", "localhost", ":1", "a:", "a:b", "a:0", "a:65536", "::1:14158", "a:1x", "[]:1"})
        EXPECT_THROW(parse_display_server(wrong), InputError) << wrong;
}

TEST(Display, PacketsAreOfAQuarterMegabyte) {
    EXPECT_EQ(tev_rows_per_packet(100000), 1);
    EXPECT_EQ(tev_rows_per_packet(1024), 21);
}

}  // namespace
}  // namespace treefarm
