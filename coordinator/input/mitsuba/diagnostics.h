// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/math/vec.h"
#include "coordinator/input/check/finding.h"
#include "coordinator/input/check/scene_limits.h"
#include "coordinator/input/check/warning.h"

namespace treefarm::mitsuba {

/// Policy for parts of a scene that cannot be rendered: strict reading stops, lenient reading collects warnings, and
/// reading for `treefarm check` continues after faults and collects findings.
class Diagnostics {
  public:
    explicit Diagnostics(bool lenient, bool checks = false, SceneLimits limits = {})
        : lenient_(lenient), checks_(checks), limits_(std::move(limits)) {}

    bool checks() const { return checks_; }
    /// Limits of the files and sizes of the scene.
    const SceneLimits& limits() const { return limits_; }

    /// Throws InputError, or, when lenient, warns that `instead` is done ("it is skipped") and returns.
    void unsupported(const Location& where, const std::string& what, const std::string& cure,
                     const std::string& instead = "it is skipped") {
        if (!lenient_) throw InputError(where, what, cure + " (with --lenient " + instead + ")");
        warn(where, what + ": " + instead);
    }

    void warn(const Location& where, const std::string& what, const char* kind = "reader") {
        if (checks_)
            find({Finding::Severity::warning, kind, where, what, ""});
        else
            warnings_.push_back({where, what});
    }

    /// Adds a remark that is no fault: to the log of a render, or to the findings.
    void note(const Location& where, const std::string& what, const char* kind = "reader") {
        if (checks_)
            find({Finding::Severity::note, kind, where, what, ""});
        else
            notes_.push_back({where, what});
    }

    /// Adds a finding, if the scene is being checked.
    void find(Finding finding) {
        // A faulty part that several shapes use is read several times.
        if (checks_ && seen_.insert(finding.text()).second) findings_.push_back(std::move(finding));
    }

    /// Reads a part of a scene. A fault ends the reading, or, when checking, the part is skipped.
    template <class Part>
    void attempt(Part read) {
        if (!checks_) return read();
        try {
            read();
        } catch (const InputError& error) {
            find({Finding::Severity::error, "refused", error.where(), error.problem(), error.cure()});
        }
    }

    std::vector<Warning>& warnings() { return warnings_; }
    std::vector<Warning>& notes() { return notes_; }
    std::vector<Finding>& findings() { return findings_; }

    /// Added to every position in the world, in double, before it becomes a float (load.cpp). 0 within groups, which
    /// have a space of their own.
    Imath::V3d world_shift{0.0};

  private:
    bool lenient_, checks_;
    SceneLimits limits_;
    std::vector<Warning> warnings_, notes_;
    std::vector<Finding> findings_;
    std::set<std::string> seen_;
};

}  // namespace treefarm::mitsuba
