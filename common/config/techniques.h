// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace treefarm {

/// Path sampling technique: numbers of vertices drawn from the lamp and from the lens, those on the lamp and on the
/// lens included.
struct Technique {
    int light = 0, camera = 0;

    bool operator==(const Technique&) const = default;
};

/// Techniques of a list "0,3 1,2": vertices from the lamp, vertices from the camera. "all" gives an empty vector. If
/// the text is malformed, `why` holds the reason and the cure.
std::vector<Technique> parse_techniques(const std::string& text, std::string& why);

/// The list as text for parse_techniques().
std::string techniques_text(const std::vector<Technique>& techniques);

/// The techniques that contribute to an image.
class TechniqueSet {
  public:
    /// `text`: valid for parse_techniques().
    explicit TechniqueSet(const std::string& text);

    bool has(int light, int camera) const;

  private:
    std::vector<Technique> listed_;  ///< empty: all
};

}  // namespace treefarm
