// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/progress.h"

namespace treefarm {

/// How far a study is, in words, and how long its cells still take by those that it has rendered.
class StudyProgress {
  public:
    explicit StudyProgress(std::size_t cells) : cells_(cells) {}

    /// The next cell begins; it has a name. One that is there from before needs no more than this.
    void begin_cell(const std::string& name);
    /// The cell was rendered, in so many seconds.
    void end_cell(double seconds);

    /// Status of this cell's render.
    Status cell_status(const RenderWords& words) const;
    /// "cell 3/24".
    std::string cell_name() const;
    /// "about 5:10 left", of the whole study, so many seconds after this cell began; empty before a cell was rendered.
    std::string left(double seconds) const;

  private:
    std::size_t cells_;
    std::size_t number_ = 0;  ///< of this cell, from 1 on
    std::string name_;
    std::size_t rendered_ = 0;
    double rendered_seconds_ = 0;
};

/// Status of a render for a study that is no cell: "reference of box", "warm-up of box".
Status aside_status(const std::string& name, const RenderWords& words);

}  // namespace treefarm
