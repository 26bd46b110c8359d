// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace treefarm {

/// A layer of the image besides its colour (an arbitrary output variable). What each holds: aov_kinds().
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

/// An AOV as users name it, and as an EXR file holds it.
struct AovKind {
    Aov aov;
    const char* name;        ///< in output.aovs, and of its layer unless another is asked for
    const char* components;  ///< a channel each: "RGB" are NAME.R, NAME.G, NAME.B; of alpha just A
    bool precise;            ///< stays 32 bits wide where colours are stored as halves
    const char* meaning;     ///< one line
};

/// All AOVs, in the order of the enum.
std::span<const AovKind> aov_kinds();
const AovKind& kind_of(Aov aov);
/// The AOV of that name, or nullptr.
const AovKind* find_aov(const std::string& name);

/// An AOV that a job asks for, under the name of its layer.
struct AovRequest {
    Aov aov;
    std::string layer;

    /// Names of its channels in the file.
    std::vector<std::string> channels() const;
};

/// The numbers that are gathered of each pixel for the AOVs of a job. Most are sums over samples; those from id_begin()
/// on are of the pixel's first sample.
class AovLayout {
  public:
    AovLayout() { at_.fill(kAbsent); }
    explicit AovLayout(std::span<const AovRequest> requests);

    static constexpr std::uint32_t kAbsent = ~0u;

    /// Index of the first of an AOV's numbers, or kAbsent. Alpha's is the number of samples that met a surface.
    std::uint32_t at(Aov aov) const { return at_[static_cast<std::size_t>(aov)]; }
    bool has(Aov aov) const { return at(aov) != kAbsent; }
    std::uint32_t size() const { return size_; }
    std::uint32_t id_begin() const { return id_begin_; }
    /// Whether the part of each pixel's colour that is direct light is gathered, too.
    bool direct() const { return direct_; }
    bool empty() const { return size_ == 0 && !direct_; }

    bool operator==(const AovLayout&) const = default;

  private:
    std::array<std::uint32_t, 13> at_;
    std::uint32_t size_ = 0, id_begin_ = 0;
    bool direct_ = false;
};

}  // namespace treefarm
