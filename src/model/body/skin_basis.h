// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "viscera/model/body/lattice.h"

namespace viscera {

/// Orthonormal frame of a surface vertex's offset and normal: tangent, normal, bitangent.
struct SkinBasis {
  Vector3d t, n, b;
  /// Returns the coordinates of a vector in this basis (EGVE eq 7).
  Vector3d coordinates(const Vector3d& v) const { return {v.dot(t), v.dot(n), v.dot(b)}; }
};

/// Returns the basis of a triangle with edges from node 0 to nodes 1 and 2, not parallel (EGVE eq 6, N and B
/// normalised).
SkinBasis triangleBasis(const Vector3d& edge1, const Vector3d& edge2);

/// Returns the sum of the unit vectors from the neighbours of a node to the node at rest (VR05 eq 5, not normalised).
/// Zero inside the body; at most 9 long.
Vector3d neighborSum(const Lattice& lattice, uint32_t slot);

/// Returns the basis at a point of a triangle at rest from the approximate normals of its nodes (EGVE eq 8,
/// orthonormalised); nothing where a node has no clear normal or where the normals disagree with each other or with the
/// triangle.
std::optional<SkinBasis> interpolatedBasis(const Lattice& lattice, const std::array<uint32_t, 3>& slots,
                                           const layout::vec4& weights, const SkinBasis& triangle);

}  // namespace viscera
