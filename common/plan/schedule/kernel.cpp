// SPDX-License-Identifier: Apache-2.0
#include "common/plan/schedule/kernel.h"

#include <algorithm>

#include "common/config/estimators.h"
#include "common/plan/schedule/learning.h"

namespace treefarm {

namespace {

KernelChoice kernel_for(const PassPlan& pass, bool plainly_diffuse, const TreeFacts& tree) {
    KernelChoice kernel;
    kernel.guided = pass.guided && tree.trained;
    kernel.record = pass.record;
    kernel.plain_diffuse = plainly_diffuse && tree.plain_kernels;
    kernel.views = tree.has_views && !kernel.plain_diffuse && (kernel.guided || kernel.record);
    return kernel;
}

}  // namespace

std::string KernelChoice::name() const {
    std::string text = plain_diffuse ? "diffuse" : "general";
    if (guided) text += ", guided";
    if (views) text += ", by view";
    if (record) text += ", recording";
    return text;
}

TreeFacts facts_of(const AnyModel& model) {
    const RegionModel& regions = model.regions();
    return model.visit([&]<class G>(const auto&) {
        return TreeFacts{regions.trained, regions.quantum_exponent.size() > regions.leaf_count(), G::kPlainKernels};
    });
}

TreeFacts facts_of(const AnySampler& guide) {
    const RegionSampler& regions = guide.regions();
    return guide.visit([&]<class G>(const auto&) {
        return TreeFacts{regions.trained(), regions.distribution_count() > regions.region_count(), G::kPlainKernels};
    });
}

KernelChoice kernel_of(const Resolved& job, const PassPlan& pass, const TreeFacts& tree) {
    return kernel_for(pass, job.scene_facts.plainly_diffuse, tree);
}

bool fits(const PassPlan& pass, bool plainly_diffuse, const TreeFacts& tree) {
    return pass.kernel == kernel_for(pass, plainly_diffuse, tree);
}

std::vector<KernelUse> kernels_of(const Resolved& job) {
    std::vector<KernelUse> uses;
    if (!estimator_of(job.integrator.type).guides) return uses;
    for (const PassPlan& pass : plan_passes(job)) {
        const bool is_trained = pass.index > 0 || !job.guiding.initial_model.empty();
        const TreeFacts facts{is_trained, job.learns_views, has_plain_kernels(guide_kind(job))};
        const KernelChoice kernel = kernel_of(job, pass, facts);
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
