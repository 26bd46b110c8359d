// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "common/film/combine.h"
#include "common/film/tail_samples.h"
#include "coordinator/passes/pass_report.h"

namespace treefarm {

/// Who carries the noise of an image (docs/design/error.md, "fireflies").
struct TailReport {
    std::optional<double> share;  ///< of the fewest pixels with two fifths of it; nothing: none is known
    TailSamples worst;            ///< of all passes in the image; noise is that of the image
    std::string origin;           ///< in words, that of most of their noise; "": none is known

    /// Whether so few samples carry so much that a person should hear of it.
    bool stands_out = false;
};
TailReport tail_report(const CombinedImage& image, std::span<const PassReport> passes);

/// What it says at the end of a render; `debug_command` and `debug_options` stand before and after the worst sample's
/// name.
std::string tail_text(const TailReport& tails, const std::string& debug_command, const std::string& debug_options);

}  // namespace treefarm
