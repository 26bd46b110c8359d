// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/check/validate.h"

#include "coordinator/input/check/validation.h"

namespace treefarm {
namespace {

void check_film(const Film& film) {
    if (film.width < 1 || film.width > 65535 || film.height < 1 || film.height > 65535)
        throw InputError(Location{},
                         "the film has " + std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels",
                         "give a width and a height of 1 to 65535");
    if (!std::isfinite(film.filter_radius) || film.filter_radius <= 0.0f || !std::isfinite(film.filter_stddev) ||
        film.filter_stddev <= 0.0f)
        throw InputError(Location{}, "the pixel filter's size is not positive", "give a positive radius or stddev");
    if (!std::isfinite(film.filter_b) || !std::isfinite(film.filter_c))
        throw InputError(Location{}, "the pixel filter's B and C are not finite",
                         "give numbers, 1/3 and 1/3 for instance");
    if (!film.is_crop_valid())
        throw InputError(Location{}, "the crop window is not on the film", "check the film's size and crop");
}

void check_camera(const Camera& camera) {
    for (const Vec3& v :
         {camera.origin, camera.corner, camera.across, camera.down, camera.lens_u, camera.lens_v, camera.parallel})
        if (!is_finite(v) || validation::is_too_far(v))
            throw InputError(Location{}, "the camera is not finite or beyond 1e18",
                             "check the sensor's transformation, field of view and lens");
}

}  // namespace

void validate_scene(Scene& scene, std::vector<Warning>& warnings) {
    validation::check_mesh_attributes(scene);
    const std::vector<ValueRange> images = validation::check_images(scene.images);
    const std::vector<ValueRange> textures = validation::check_textures(scene, images);
    validation::check_materials(scene, textures, warnings);
    validation::check_shapes(scene, warnings);
    validation::check_emitters(scene, images, textures);
    check_film(scene.film);
    check_camera(scene.camera);
    if (scene.shapes.empty()) warnings.push_back(Warning{Location{}, "the scene has no shapes"});
    if (scene.emitters.empty())
        warnings.push_back(
            Warning{Location{}, "the scene has no emitters: it renders black, unless the integrator needs no light"});
}

}  // namespace treefarm
