// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/progress.h"

namespace treefarm {

/// How far a series of renders is, in words, and how long the others still take by those that it has rendered.
class SeriesProgress {
  public:
    /// `noun`: what each of them is called, "cell" or "frame".
    SeriesProgress(std::string noun, std::size_t count) : noun_(std::move(noun)), count_(count) {}

    /// The next one begins; it has a name. One that is there from before needs no more than this.
    void begin(const std::string& name);
    /// The render is done, in so many seconds.
    void end(double seconds);

    /// Status of this render.
    Status status(const RenderWords& words) const;
    /// "cell 3/24".
    std::string position() const;
    /// "about 5:10 left", of the whole series, so many seconds after this one began; empty before one was rendered.
    std::string left(double seconds) const;

  private:
    std::string noun_;
    std::size_t count_;
    std::size_t number_ = 0;  ///< of this one, from 1 on
    std::string name_;
    std::size_t rendered_ = 0;
    double rendered_seconds_ = 0;
};

/// Status of a render for a study that is no cell: "reference of box", "warm-up of box".
Status auxiliary_status(const std::string& name, const RenderWords& words);

}  // namespace treefarm
