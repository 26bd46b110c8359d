#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/math/vec.h"
#include "common/scene/warning.h"

namespace treefarm::mitsuba {

/// What to do about things in a scene that cannot be rendered: strict reading stops, lenient reading collects warnings.
class Diagnostics {
  public:
    explicit Diagnostics(bool lenient) : lenient_(lenient) {}

    /// Throws InputError, or, when lenient, warns that `instead` is done ("it is skipped") and returns.
    void unsupported(const Location& where, const std::string& what, const std::string& cure,
                     const std::string& instead = "it is skipped") {
        if (!lenient_) throw InputError(where, what, cure + " (with --lenient " + instead + ")");
        warn(where, what + ": " + instead);
    }

    void warn(const Location& where, const std::string& what) { warnings_.push_back({where, what}); }

    std::vector<Warning>& warnings() { return warnings_; }

    /// Added to every position in the world, in double, before it becomes a float (read_mitsuba.cpp). 0 within groups,
    /// which have a space of their own.
    Imath::V3d world_shift{0.0};

  private:
    bool lenient_;
    std::vector<Warning> warnings_;
};

}  // namespace treefarm::mitsuba
