// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "common/image/image.h"
#include "coordinator/study/cell_request.h"
#include "coordinator/study/study.h"

namespace treefarm {

/// The image that cells of a scene are measured against.
struct Reference {
    std::string file;
    std::string key;  ///< of its pixels or of what renders it
    RgbImage image;   ///< empty until it is needed
    nlohmann::ordered_json about;

    /// The file that says that a rendered reference is whole: an interrupted one has an image, too, but not this.
    std::filesystem::path mark() const { return std::filesystem::path(file).parent_path() / "reference.json"; }
};

/// A reference that is given, or the request that renders one.
std::string reference_key(const Study& study, const StudyScene& scene, const LoadedScene& loaded, Reference& reference,
                          RenderRequest& request, const Fingerprint& build);

}  // namespace treefarm
