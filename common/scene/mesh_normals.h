#pragma once

#include "common/scene/scene.h"

namespace treefarm {

/// Gives every vertex without a normal (a zero vector) the mean of its triangles' normals, weighted by their angle
/// there (Thuermer and Wuethrich 1998). `mesh.normals` may be empty: all are computed then.
void compute_missing_normals(Mesh& mesh);

/// Turns all triangles round.
void flip_winding(Mesh& mesh);

/// Turns those triangles round whose front is not where their vertices' normals point.
void orient_by_normals(Mesh& mesh);

/// Removes the normals if they say no more than the triangles do (to 1e-5).
void drop_redundant_normals(Mesh& mesh);

}  // namespace treefarm
