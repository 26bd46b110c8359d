#pragma once

#include <string>

#include "coordinator/pass_loop.h"

namespace treefarm {

/// A line at the bottom of the terminal: how far, how good, how long still. Redrawn a few times a second.
class ProgressBar {
  public:
    /// `shown`: only where a person looks on (standard error is a terminal, not --quiet).
    explicit ProgressBar(bool shown) : shown_(shown) {}
    ~ProgressBar() { clear(); }

    void update(const RenderProgress& progress, double elapsed_seconds);
    /// Wipes the line, so that something else can be printed; the next update() draws it again.
    void clear();

    /// The text of the line.
    static std::string text(const RenderProgress& progress, double elapsed_seconds);

  private:
    bool shown_;
    bool drawn_ = false;
    double last_ = -1e9;
};

}  // namespace treefarm
