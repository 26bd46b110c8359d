// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace treefarm {

/// Layer of the image besides its colour (arbitrary output variable). Contents: aov_kinds().
enum class Aov : std::uint8_t {
    albedo,
    normal,
    geometric_normal,
    depth,
    distance,
    position,
    uv,
    shape,
    material,
    alpha,
    direct,
    indirect,
    spp,
};

/// Name and properties of an AOV for users and EXR files.
struct AovKind {
    Aov aov;
    const char* name;        ///< name in output.aovs; also the layer's default name
    const char* components;  ///< one channel each: "RGB" stands for NAME.R, NAME.G, NAME.B; alpha has A alone
    bool precise;            ///< stays 32 bits wide where colours are stored as halves
    const char* meaning;     ///< one line
};

/// All AOVs, in the order of the enum.
std::span<const AovKind> aov_kinds();
const AovKind& kind_of(Aov aov);
/// The AOV of this name, or nullptr.
const AovKind* find_aov(const std::string& name);

/// A requested AOV and its layer's name.
struct AovRequest {
    Aov aov;
    std::string layer;

    /// Names of its channels in the file.
    std::vector<std::string> channels() const;
};

/// Layout of the numbers gathered per pixel for a job's AOVs. Most are sums over samples; those from id_begin() on are
/// of the pixel's first sample.
class AovLayout {
  public:
    AovLayout() { at_.fill(kAbsent); }
    explicit AovLayout(std::span<const AovRequest> requests);

    static constexpr std::uint32_t kAbsent = ~0u;

    /// Index of an AOV's first number, or kAbsent. Alpha counts the samples that hit a surface.
    std::uint32_t at(Aov aov) const { return at_[static_cast<std::size_t>(aov)]; }
    bool has(Aov aov) const { return at(aov) != kAbsent; }
    std::uint32_t size() const { return size_; }
    std::uint32_t id_begin() const { return id_begin_; }
    /// Whether direct light is gathered as well, per pixel.
    bool direct() const { return direct_; }
    bool empty() const { return size_ == 0 && !direct_; }

    bool operator==(const AovLayout&) const = default;

  private:
    std::array<std::uint32_t, 13> at_;
    std::uint32_t size_ = 0, id_begin_ = 0;
    bool direct_ = false;
};

}  // namespace treefarm
