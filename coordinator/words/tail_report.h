// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "common/film/combine.h"
#include "common/film/tail_samples.h"
#include "coordinator/passes/pass_report.h"

namespace treefarm {

/// Report on the samples that carry an image's noise (docs/design/error.md, "fireflies").
struct TailReport {
    std::optional<double> share;  ///< of the fewest pixels with two fifths of it; nothing: none is known
    TailSamples worst;            ///< of all passes in the image; noise relative to the image
    std::string origin;           ///< in words, of most of their noise; without light that the camera sees directly,
                                  ///< since the edge of a lamp is no firefly; "": unknown

    /// Whether few samples carry so much noise that the user should be told.
    bool stands_out = false;
};
TailReport tail_report(const CombinedImage& image, std::span<const PassReport> passes);

/// Line for the end of a render: how few pixels have how much of the noise, and its origin.
std::string tail_text(const TailReport& tails);

/// Line for the log: the command that traces the worst sample whose light the camera does not see directly;
/// `debug_command` and `debug_options` precede and follow its name.
std::string tail_command(const TailReport& tails, const std::string& debug_command, const std::string& debug_options);

}  // namespace treefarm
