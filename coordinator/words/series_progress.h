// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/words/progress.h"

namespace treefarm {

/// Progress of a series of renders in words, with a forecast of the remaining time from those already rendered.
class SeriesProgress {
  public:
    /// `noun`: name of one render, "cell" or "frame".
    SeriesProgress(std::string noun, std::size_t count) : noun_(std::move(noun)), count_(count) {}

    /// Begins the next render; `name`: its name. For one that exists already this is the only call.
    void begin(const std::string& name);
    /// Ends the render, which took `seconds`.
    void end(double seconds);

    /// Status of this render.
    Status status(const RenderWords& words) const;
    /// Number of this render: "cell 3/24".
    std::string position() const;
    /// "about 5:10 left" for the whole series, `seconds` after this render began; empty before one was rendered.
    std::string left(double seconds) const;

  private:
    std::string noun_;
    std::size_t count_;
    std::size_t number_ = 0;  ///< of this render, from 1 on
    std::string name_;
    std::size_t rendered_ = 0;
    double rendered_seconds_ = 0;
};

/// Status of a study's render that is not a cell: "reference of box", "warm-up of box".
Status auxiliary_status(const std::string& name, const RenderWords& words);

}  // namespace treefarm
