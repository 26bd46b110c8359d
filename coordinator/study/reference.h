// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "common/image/image.h"
#include "coordinator/study/cell_request.h"
#include "coordinator/study/study.h"

namespace treefarm {

/// Reference image of a scene's cells.
struct Reference {
    std::string file;
    std::string key;  ///< key of its pixels, or of the request that renders it
    RgbImage image;   ///< empty until it is needed
    nlohmann::ordered_json about;

    /// Marker file of a completely rendered reference: an interrupted one has an image, too, but no marker.
    std::filesystem::path mark() const { return std::filesystem::path(file).parent_path() / "reference.json"; }
    /// Whether a rendered reference is complete.
    bool is_there() const;
};

/// Key of a given reference, or of the request that renders one.
std::string reference_key(const Study& study, const StudyScene& scene, const LoadedScene& loaded, Reference& reference,
                          RenderRequest& request, const RenderOrigin& origin);

}  // namespace treefarm
