// SPDX-License-Identifier: Apache-2.0
#include "common/film/light_origin.h"

namespace treefarm {
namespace {

const char* words(PathClass path_class) {
    switch (path_class) {
        case PathClass::diffuse:
            return " off diffuse surfaces";
        case PathClass::glossy:
            return " off glossy surfaces";
        case PathClass::mirror:
            return " in mirrors";
        case PathClass::smooth_glass:
            return " through smooth glass";
        case PathClass::rough_glass:
            return " through rough glass";
        case PathClass::sheet:
            return " through thin sheets that scatter it";
    }
    return "";
}

}  // namespace

bool is_known(const LightOrigin& origin) {
    return origin.found <= LightFound::sky_sampled && origin.path_class <= PathClass::sheet;
}

std::string words(const LightOrigin& origin) {
    const bool of_sky = origin.found == LightFound::sky_met || origin.found == LightFound::sky_sampled;
    const bool sampled = origin.found == LightFound::sampled || origin.found == LightFound::sky_sampled;
    const std::string light = of_sky ? "light of the environment" : "light";
    if (origin.vertices <= 1 && !sampled) return light + " that the camera sees";
    return light + words(origin.path_class) + (sampled ? ", sampled by next event" : ", met by chance");
}

}  // namespace treefarm
