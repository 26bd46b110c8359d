#pragma once

namespace treefarm {

/// SIGINT and SIGTERM as something to ask about. Blocks them for this thread and the threads it starts from now on; no
/// handler, no global state.
class InterruptWatch {
  public:
    InterruptWatch();
    /// True once a signal has come.
    bool interrupted();

  private:
    bool seen_ = false;
};

}  // namespace treefarm
