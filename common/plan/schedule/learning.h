// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/evidence/evidence.h"
#include "common/guiding/any_guide.h"
#include "common/guiding/regions/refinement.h"
#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// The guide of a job. A job without guiding has one, too, whose model stays unused.
GuideKind guide_kind(const Job& job);
/// Whether a guide has kernels of its own for plainly diffuse scenes; otherwise the general ones trace these.
bool has_plain_kernels(GuideKind guide);

/// The guide's model before the first pass, over `bounds`; a mean record is about `radiance_scale`.
AnyModel first_model(const Resolved& job, const Box3& bounds, float radiance_scale);
/// The model before the first pass, over everything that the scene's camera can see.
AnyModel first_model(const Resolved& job, const Scene& scene);

/// Settings of the job for refining the tree after `pass` for `coming`.
RefineSettings refine_settings(const Resolved& job, const PassPlan& pass, const PassPlan& coming);

/// Owners of a pass's evidence, in their order; only passes that record have the guide's.
enum EvidenceOwner : std::size_t { kDecisionsEvidence, kGuideEvidence };

/// Evidence of a pass over `model` before its first work unit.
Evidence no_evidence(const PassPlan& pass, const AnyModel& model);

}  // namespace treefarm
