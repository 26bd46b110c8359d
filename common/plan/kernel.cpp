#include "common/plan/kernel.h"

#include <algorithm>

#include "common/scene/material_traits.h"

namespace treefarm {

std::string KernelChoice::name() const {
    std::string text = plain_diffuse ? "diffuse" : "general";
    if (guided) text += ", guided";
    if (views) text += ", by view";
    if (record) text += ", recording";
    return text;
}

KernelChoice kernel_of(const Job& job, const PassPlan& pass, bool plain_diffuse, bool views) {
    KernelChoice kernel;
    kernel.plain_diffuse = plain_diffuse;
    kernel.guided = job.guiding.type != GuidingType::none && pass.guided && pass.index > 0;
    kernel.record = pass.record;
    kernel.views = views && (kernel.guided || kernel.record);
    return kernel;
}

bool learns_views(const Scene& scene, const Job& job) {
    return uses_views(job.guiding.type) && scene_traits(scene).lobes.view_dependent();
}

std::vector<KernelUse> kernels_of(const Scene& scene, const Job& job) {
    const bool plain = is_plainly_diffuse(scene);
    const bool views = learns_views(scene, job);
    std::vector<KernelUse> uses;
    for (const PassPlan& pass : plan_passes(job)) {
        const KernelChoice kernel = kernel_of(job, pass, plain, views);
        const auto known =
            std::find_if(uses.begin(), uses.end(), [&](const KernelUse& u) { return u.kernel == kernel; });
        if (known != uses.end())
            known->passes.push_back(pass.index);
        else
            uses.push_back({kernel, {pass.index}});
    }
    return uses;
}

}  // namespace treefarm
