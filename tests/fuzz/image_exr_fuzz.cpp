// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <cstring>

#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/image_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    treefarm::fuzz::read_image(data, size);
    return 0;
}

namespace {

class TextStream : public Imf::OStream {
  public:
    TextStream() : Imf::OStream("memory") {}
    void write(const char bytes[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        text_.resize(std::max(text_.size(), at_ + size));
        std::memcpy(text_.data() + at_, bytes, size);
        at_ += size;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }
    const std::string& text() const { return text_; }

  private:
    std::string text_;
    std::size_t at_ = 0;
};

constexpr int kWidth = 11, kHeight = 6;

std::string exr(Imf::Compression compression, Imf::PixelType type, int tile) {
    Imf::Header header(kWidth, kHeight);
    header.compression() = compression;
    header.insert("treefarm.note", Imf::StringAttribute("text"));
    std::vector<float> floats(kWidth * kHeight);
    std::vector<std::uint16_t> halves(kWidth * kHeight);
    for (std::size_t i = 0; i < floats.size(); ++i) {
        floats[i] = 0.01f * static_cast<float>(i * i % 97);
        halves[i] = static_cast<std::uint16_t>(0x3000 + 37 * i);
    }
    const bool half = type == Imf::HALF;
    char* base = half ? reinterpret_cast<char*>(halves.data()) : reinterpret_cast<char*>(floats.data());
    const std::size_t stride = half ? 2 : 4;
    Imf::FrameBuffer pixels;
    for (const char* name : {"B", "G", "R"}) {
        header.channels().insert(name, Imf::Channel(type));
        pixels.insert(name, Imf::Slice(type, base, stride, stride * kWidth));
    }
    TextStream stream;
    if (tile > 0) {
        const auto side = static_cast<unsigned>(tile);
        header.setTileDescription(Imf::TileDescription(side, side, Imf::ONE_LEVEL));
        Imf::TiledOutputFile file(stream, header, 0);
        file.setFrameBuffer(pixels);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(stream, header, 0);
        file.setFrameBuffer(pixels);
        file.writePixels(kHeight);
    }
    return stream.text();
}

}  // namespace

std::vector<std::string> treefarm::fuzz::seeds() {
    std::vector<std::string> files;
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
          Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION})
        files.push_back(exr(compression, Imf::HALF, 0));
    files.push_back(exr(Imf::ZIP_COMPRESSION, Imf::FLOAT, 0));
    files.push_back(exr(Imf::ZIP_COMPRESSION, Imf::HALF, 4));
    files.push_back(exr(Imf::NO_COMPRESSION, Imf::FLOAT, 4));
    return files;
}
