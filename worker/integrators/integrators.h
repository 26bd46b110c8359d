// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

// Each estimator's function of Integrator::prepare, which is defined in its own folder.
namespace treefarm {

/// Guided path tracing in batches (docs/design/speed.md).
RenderUnit prepare_path(std::shared_ptr<const TraceScene> scene, const Resolved& job);

/// Unguided path tracing, one path at a time: the code to read first, and the reference for the other estimators. It
/// uses the random numbers of the unguided batch walk (path/path_walk.h).
RenderUnit prepare_reference(std::shared_ptr<const TraceScene> scene, const Resolved& job);

/// Direct light at the first visible surface: integrator.emitter_samples emitter samples and integrator.bsdf_samples
/// BSDF samples, combined by multiple importance sampling.
RenderUnit prepare_direct(std::shared_ptr<const TraceScene> scene, const Resolved& job);

/// Shading normal n of the first visible surface as the colour (1 + n) / 2; black where the camera sees nothing.
/// Without bumps, and n is not turned towards the camera, so that inverted surfaces are visible.
RenderUnit prepare_normals(std::shared_ptr<const TraceScene> scene, const Resolved& job);

/// Ambient occlusion: 1 / pi times the integral of cos over the unoccluded directions, about the shading normal on the
/// camera's side; a surface occludes if it is nearer than integrator.ao_distance. 1 where the camera sees nothing.
RenderUnit prepare_ao(std::shared_ptr<const TraceScene> scene, const Resolved& job);

/// Light tracing: paths start at emitters, and each vertex is connected to the camera (docs/design/transport.md).
/// Efficient for caustics of small lamps; blind to light that reaches the camera by a mirror or smooth glass.
RenderUnit prepare_light(std::shared_ptr<const TraceScene> scene, const Resolved& job);

/// Bidirectional path tracing: for each sample a camera subpath and a light subpath, all pairs of whose vertices are
/// connected (docs/design/transport.md). It covers the transport of both path tracing and light tracing.
RenderUnit prepare_bidirectional(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
