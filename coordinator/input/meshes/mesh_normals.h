// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"

namespace treefarm {

/// Gives every vertex without a normal (a zero vector) the mean of its triangles' normals, weighted by their angle
/// there (Thuermer and Wuethrich 1998). `mesh.normals` may be empty: all are computed then.
void compute_missing_normals(Mesh& mesh);

/// Turns all triangles round.
void flip_winding(Mesh& mesh);

/// Turns those triangles round whose front is not where their vertices' normals point.
void orient_by_normals(Mesh& mesh);

/// Drops the normals and gives triangles that share a place and texture coordinates there one vertex only if their
/// normals agree to an angle of this cosine, so that smooth normals keep sharper edges. Triangles gather about the
/// first one that fits, in their order, as Mitsuba 0.6 does (maxSmoothAngle).
void split_at_edges(Mesh& mesh, double min_cosine);

/// Removes the normals if they say no more than the triangles do (to 1e-5).
void drop_redundant_normals(Mesh& mesh);

}  // namespace treefarm
