// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace treefarm {

/// A way to draw a path from lamp to lens: how many of its vertices are drawn from either end. The lamp's and the
/// lens's own are among them.
struct Technique {
    int light = 0, camera = 0;

    bool operator==(const Technique&) const = default;
};

/// The techniques in a list "0,3 1,2" of vertices from the lamp and from the camera; all of them for "all", which is an
/// empty vector. If the text is no such list, `why` says why, and what to do.
std::vector<Technique> parse_techniques(const std::string& text, std::string& why);

/// The list as parse_techniques() reads it.
std::string techniques_text(const std::vector<Technique>& techniques);

/// The techniques of which an image is made.
class TechniqueSet {
  public:
    /// `text`: one that parse_techniques() takes.
    explicit TechniqueSet(const std::string& text);

    bool has(int light, int camera) const;

  private:
    std::vector<Technique> listed_;  ///< empty: all
};

}  // namespace treefarm
