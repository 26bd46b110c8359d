// SPDX-License-Identifier: Apache-2.0
// Cost of a kind of material per vertex: one sample and one value, with its default inputs and, if it has a roughness,
// rough. Names are CHOICE/WAY: docs/generated/cost-of-accuracy.md reads them.
#include <benchmark/benchmark.h>

#include "common/base/random.h"
#include "common/math/warp.h"
#include "common/scene/kinds/kind_name.h"
#include "tests/support/kind_scenes.h"
#include "worker/shading/material_set.h"

namespace treefarm {
namespace {

struct Vertex {
    Vec3 wo, to_light;
    BsdfRandom random{0.0f, Vec2(0.0f)};
};

std::vector<Vertex> vertices() {
    std::vector<Vertex> all(4096);
    for (std::uint32_t i = 0; i < all.size(); ++i) {
        const auto number = [&](Stream stream) { return draw({7, i, 0}, 0, stream); };
        const Draw a = number(Stream::camera), b = number(Stream::scatter);
        all[i].wo = square_to_cosine_hemisphere({to_unit(a[0]), to_unit(a[1])});
        all[i].to_light = square_to_cosine_hemisphere({to_unit(a[2]), to_unit(a[3])});
        all[i].random = {to_unit(b[0]), {to_unit(b[1]), to_unit(b[2])}};
    }
    return all;
}

void measure(benchmark::State& state, const MaterialKind& kind) {
    Scene scene;
    scene.materials.emplace_back().bsdf = DiffuseMaterial{Rgb(0.5f)};
    scene.materials.emplace_back().bsdf = kind;
    scene.shapes = {{Sphere{}, 1, kNone, kNone, "", {}}};
    const TextureSet textures;
    const MaterialSet materials(scene, textures);
    const Bsdf* bsdf = materials.side(0, false).bsdf;
    if (!bsdf) return state.SkipWithError("is black or varies");
    const std::vector<Vertex> all = vertices();
    std::size_t i = 0;
    for (auto _ : state) {
        const Vertex& v = all[i++ % all.size()];
        benchmark::DoNotOptimize(bsdf->value(v.wo, v.to_light));
        benchmark::DoNotOptimize(bsdf->sample(v.wo, v.random));
    }
    state.SetItemsProcessed(state.iterations());
    state.counters["bytes"] = double(std::visit([]<class Kind>(const Kind&) { return sizeof(Kind); }, bsdf->kind));
}

/// Words of a type name: "RoughDiffuseMaterial" -> "rough diffuse".
std::string words(const std::string& type) {
    std::string text;
    for (const char c : type.substr(0, type.find("Material"))) {
        const bool begins = 'A' <= c && c <= 'Z';
        if (begins && !text.empty()) text += ' ';
        text += begins ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return text;
}

void add(const std::string& name, const MaterialKind& kind) {
    benchmark::RegisterBenchmark(("materials/" + name).c_str(),
                                 [kind](benchmark::State& state) { measure(state, kind); });
}

}  // namespace
}  // namespace treefarm

int main(int argc, char** argv) {
    using namespace treefarm;
    for_each_kind<MaterialKind>([]<class Kind>() {
        Kind kind;
        test::ReferToTheFirst refer;
        Kind::fields(kind, refer);
        const std::string name = words(kind_name<Kind>());
        if constexpr (requires { kind.roughness.smooth(); }) {
            const bool smooth = kind.roughness.smooth();
            add((smooth ? "smooth " : "rough ") + name, kind);
            kind.roughness = {Microfacets::ggx, {0.2f}, {0.2f}};
            if (smooth) add("rough " + name, kind);
        } else {
            add(name, kind);
        }
    });
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
