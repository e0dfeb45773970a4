// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/skin_basis.h"

#include "viscera/layout/skin.h"

namespace viscera {

namespace {

constexpr double kLeastAverage = 0.5;  // smallest length of the averaged normal; below, the three normals disagree
// Smallest cosine between averaged and triangle normal; also keeps N_c away from T.
constexpr double kLeastAgreement = 0.3;

}  // namespace

SkinBasis triangleBasis(const Vector3d& edge1, const Vector3d& edge2) {
  SkinBasis basis;
  basis.t = edge1.normalized();
  basis.n = basis.t.cross(edge2).normalized();
  basis.b = basis.n.cross(basis.t);
  return basis;
}

Vector3d neighborSum(const Lattice& lattice, uint32_t slot) {
  Vector3d sum = Vector3d::Zero();
  for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
    if (!springCount(lattice.nodes[slot], spring)) continue;
    const auto& o = kNeighborOffsets[spring];
    sum -= Vector3d(o[0], o[1], o[2]).normalized();
  }
  return sum;
}

std::optional<SkinBasis> interpolatedBasis(const Lattice& lattice, const std::array<uint32_t, 3>& slots,
                                           const layout::vec4& weights, const SkinBasis& triangle) {
  const std::array<double, 3> w = {weights.x, weights.y, weights.z};
  Vector3d average = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector3d sum = neighborSum(lattice, slots[i]);
    if (sum.norm() < layout::kNormalSumFull) return std::nullopt;
    average += w[i] * sum.normalized();
  }
  if (average.norm() < kLeastAverage) return std::nullopt;
  SkinBasis basis;
  basis.n = average.normalized();
  if (basis.n.dot(triangle.n) < kLeastAgreement) return std::nullopt;
  basis.b = basis.n.cross(triangle.t).normalized();
  basis.t = basis.b.cross(basis.n);
  return basis;
}

}  // namespace viscera
