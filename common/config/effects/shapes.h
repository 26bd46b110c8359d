// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>

#include "common/config/effects/row.h"

namespace treefarm {

inline constexpr NoSwitch kChangeShapes = instead("change the scene's shapes");

inline constexpr auto kShapeEffects = std::tuple(
    effect(
        {"masks", "shapes", "surfaces that are not met everywhere", "a shape's material has an opacity below 1",
         "a call and a lookup for every surface that a ray may meet"},
        [](const auto& find) { return find.masks(); },
        replaced(2, "masked surfaces are whole", [](auto& scene) { scene.masks(); })),
    effect(
        {"triangles", "shapes", "meshes, rectangles and cubes", "a shape is a mesh",
         "its arrays: 12 bytes per triangle, 12 to 32 per vertex; hierarchy: 67 bytes per triangle"},
        [](const auto& find) { return find.triangles(); }, kChangeShapes),
    effect(
        {"smooth_normals", "shapes", "normals interpolated over triangles", "a mesh has normals",
         "12 bytes per vertex"},
        [](const auto& find) { return find.smooth_normals(); }, instead("set faceNormals in the scene's shapes")),
    effect(
        {"analytic_shapes", "shapes", "spheres, disks and cylinders without triangles", "a shape is one of them",
         "400 bytes each"},
        [](const auto& find) { return find.analytic_shapes(); }, kChangeShapes),
    effect(
        {"instances", "shapes", "groups of shapes placed several times", "a shape is an instance",
         "400 bytes each; a second level of hierarchy"},
        [](const auto& find) { return find.instances(); }, kChangeShapes));

inline constexpr auto kCameraEffects = std::tuple(
    effect(
        {"lens", "camera", "depth of field of a thin lens", "the sensor is a thin lens with an aperture",
         "no memory; two random numbers per path"},
        [](const auto& find) { return find.lens(); },
        replaced(10, "everything is in focus", [](auto& scene) { scene.lens(); })),
    effect(
        {"pixel_filter", "camera", "a wide box, tent, Gaussian, cubic or Lanczos filter, sampled",
         "the film's filter is not a box of one pixel", "no memory"},
        [](const auto& find) { return find.pixel_filter(); }, instead("set a box filter in the scene's film")));

}  // namespace treefarm
