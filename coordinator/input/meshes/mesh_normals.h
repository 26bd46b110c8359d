// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"

namespace treefarm {

/// Sets every missing vertex normal (a zero vector) to the mean of its triangles' normals, weighted by their angles
/// there (Thuermer and Wuethrich 1998). If `mesh.normals` is empty, all are computed.
void compute_missing_normals(Mesh& mesh);

/// Reverses the orientation of all triangles.
void flip_winding(Mesh& mesh);

/// Reverses the triangles whose front is opposite to their vertices' normals.
void orient_by_normals(Mesh& mesh);

/// Removes the normals and splits vertices so that triangles share one (position and texture coordinates) only if their
/// normals differ by at most the angle with cosine `min_cosine`: smooth normals then keep sharper edges. Triangles join
/// the first cluster that fits, in order, as in Mitsuba 0.6 (maxSmoothAngle).
void split_at_edges(Mesh& mesh, double min_cosine);

/// Removes the normals if they equal those of the triangles (to 1e-5).
void drop_redundant_normals(Mesh& mesh);

}  // namespace treefarm
