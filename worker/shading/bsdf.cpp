#include "worker/shading/bsdf.h"

namespace treefarm {

Bsdf make_bsdf(const Scene& scene, std::int32_t material) {
    Bsdf bsdf;
    if (material == kNone) return bsdf;
    const Material& m = scene.materials[static_cast<std::size_t>(material)];
    bsdf.twosided = m.twosided;
    bsdf.reflectance = std::get<DiffuseMaterial>(m.bsdf).reflectance.value;
    bsdf.kind = is_black(bsdf.reflectance) ? Bsdf::Kind::black : Bsdf::Kind::diffuse;
    return bsdf;
}

}  // namespace treefarm
