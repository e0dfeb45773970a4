// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The mapping of the surface mesh in float64, written from the papers' equations and not from the kernels.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "viscera/model/body/skin.h"

namespace viscera::testing {

/// Form of EGVE eqs 6 and 8: orthonormal (physics.md 4), or as printed, without normalising N and N_c.
enum class Bases { kOrthonormal, kAsPrinted };

class ReferenceMapping {
 public:
  ReferenceMapping(const Lattice& lattice, const std::vector<layout::vec4>& displacement_m,
                   const std::vector<layout::NodeBits>& nodes, Bases bases = Bases::kOrthonormal,
                   bool normals_by_sum = false)
      : lattice_(lattice),
        displacement_m_(displacement_m),
        nodes_(nodes),
        bases_(bases),
        normals_by_sum_(normals_by_sum) {}

  struct Vertex {
    Vector3d position_m, normal;
  };
  Vertex map(const layout::SkinBinding& s) const {
    return (s.springs & layout::kInCellBit) && !isCellCut(s) ? mapInCell(s) : mapByTriangle(s);
  }
  /// Maps a vertex as if it were not in a cell.
  Vertex mapByTriangle(const layout::SkinBinding& s) const {
    const Vector3d p1 = position(s.slot0), p2 = position(s.slot1), p3 = position(s.slot2);
    const Vector3d t = (p2 - p1).normalized(), b_t = (p3 - p1).normalized();
    const Vector3d n = normalised(t.cross(b_t)), b = n.cross(t);
    Vector3d offset = sum(s.offset_constant, t, n, b), normal = sum(s.normal_constant, t, n, b);
    if (s.springs & layout::kInterpolatedBit) {
      const std::array<Normal, 3> a = {approximate(s.slot0), approximate(s.slot1), approximate(s.slot2)};
      const double trust = std::min({a[0].trust, a[1].trust, a[2].trust});
      const Vector3d n_c = normalised(s.weights.x * a[0].unit + s.weights.y * a[1].unit + s.weights.z * a[2].unit);
      const Vector3d b_c = normalised(n_c.cross(t)), t_c = b_c.cross(n_c);
      offset += trust * (sum(s.offset_interpolated, t_c, n_c, b_c) - offset);
      normal += trust * (sum(s.normal_interpolated, t_c, n_c, b_c) - normal);
    }
    const double w[3] = {1.0 - s.weights.y - s.weights.z, s.weights.y, s.weights.z};
    const double own = s.springs & layout::kOwnNormalBit ? 0 : 1;
    if (s.springs & layout::kOneNodeBit) {
      const Normal a = approximate(s.slot0);
      normal += own * a.trust * (a.unit - normal);
      return {p1 + atRest(s), normal.normalized()};
    }
    if (s.springs & layout::kAlongNormalBit) {
      const std::array<Normal, 3> a = {approximate(s.slot0), approximate(s.slot1), approximate(s.slot2)};
      const double trust = std::min({a[0].trust, a[1].trust, a[2].trust});
      const Vector3d along = normalised(w[0] * a[0].unit + w[1] * a[1].unit + w[2] * a[2].unit);
      offset += trust * (s.weights.w * along - offset);
      normal += own * trust * (along - normal);
    }
    return {w[0] * p1 + w[1] * p2 + w[2] * p3 + offset, normal.normalized()};
  }

 private:
  /// Returns the offset at rest.
  Vector3d atRest(const layout::SkinBinding& s) const {
    const Vector3d p1 = lattice_.restPosition(s.slot0);
    const Vector3d t = (lattice_.restPosition(s.slot1) - p1).normalized();
    const Vector3d n = t.cross(lattice_.restPosition(s.slot2) - p1).normalized();
    return sum(s.offset_constant, t, n, n.cross(t));
  }
  Vector3i lowestCorner(const layout::SkinBinding& s) const {
    const uint32_t own = s.springs >> layout::kCornerShift & 7u;
    return lattice_.nodeAt(s.slot0) - Vector3i(own & 1u, own >> 1 & 1u, own >> 2);
  }
  bool isCellCut(const layout::SkinBinding& s) const {
    bool cut = false;
    forEachCorner(lattice_, static_cast<uint32_t>(lattice_.slotAt(lowestCorner(s))),
                  [&](const Vector3i&, uint32_t slot) { cut |= (nodes_[slot].lo & layout::kSeveredBit) != 0; });
    return cut;
  }
  /// Maps by trilinear interpolation; the normal by two tangents, from differences.
  Vertex mapInCell(const layout::SkinBinding& s) const {
    const Vector3d p1 = lattice_.restPosition(s.slot0), p2 = lattice_.restPosition(s.slot1),
                   p3 = lattice_.restPosition(s.slot2);
    const Vector3d t = (p2 - p1).normalized(), n = t.cross(p3 - p1).normalized(), b = n.cross(t);
    const Vector3d point = p1 + s.weights.y * (p2 - p1) + s.weights.z * (p3 - p1) + sum(s.offset_constant, t, n, b);
    const Vector3d normal = sum(s.normal_constant, t, n, b).normalized();
    const Vector3d tangent = normal.unitOrthogonal() * 1e-4 * lattice_.spacing_m, other = normal.cross(tangent);
    const auto carried = [&](const Vector3d& x) { return carriedInCell(lowestCorner(s), x); };
    const Vector3d along = carried(point + tangent) - carried(point - tangent);
    const Vector3d aside = carried(point + other) - carried(point - other);
    return {carried(point), along.cross(aside).normalized()};
  }
  Vector3d carriedInCell(const Vector3i& lowest, const Vector3d& x) const {
    const Vector3d p = (x - lattice_.origin_m) / lattice_.spacing_m - lowest.cast<double>();
    Vector3d moved = Vector3d::Zero();
    forEachCorner(lattice_, static_cast<uint32_t>(lattice_.slotAt(lowest)), [&](const Vector3i& corner, uint32_t slot) {
      double weight = 1;
      for (int a = 0; a < 3; ++a) weight *= corner[a] ? p[a] : 1 - p[a];
      moved += weight * position(slot);
    });
    return moved;
  }
  struct Normal {
    Vector3d unit;
    double trust;
  };
  Vector3d position(uint32_t slot) const {
    const layout::vec4& u = displacement_m_[slot];
    return lattice_.restPosition(slot) + Vector3d(u.x, u.y, u.z);
  }
  Vector3d normalised(const Vector3d& v) const { return bases_ == Bases::kOrthonormal ? v.normalized() : v; }
  static Vector3d sum(const layout::vec4& c, const Vector3d& t, const Vector3d& n, const Vector3d& b) {
    return c.x * t + c.y * n + c.z * b;
  }
  Normal approximate(uint32_t slot) const {
    Vector3d total = Vector3d::Zero(), at_rest = Vector3d::Zero();
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
      if (!springCount(nodes_[slot], spring)) continue;
      const auto neighbor = static_cast<uint32_t>(lattice_.neighborSlot(slot, spring));
      const Vector3d rest = lattice_.restPosition(slot) - lattice_.restPosition(neighbor);
      const Vector3d now = position(slot) - position(neighbor);
      total += now.normalized();
      at_rest += rest.normalized();
      if (spring >= layout::kAxialSprings) continue;
      const bool both = springCount(nodes_[slot], spring ^ 1u) != 0;
      gradient += (both ? 0.5 : 1) * now * rest.transpose() / rest.squaredNorm();
    }
    const bool severed = (nodes_[slot].lo & layout::kSeveredBit) != 0;
    if (!normals_by_sum_) {
      const Vector3d plane = gradient.determinant() * gradient.inverse().transpose() * at_rest;
      return {(plane.normalized() + (gradient * at_rest).normalized()).normalized(), severed ? 0.0 : 1.0};
    }
    const double clear = (total.norm() - layout::kNormalSumNone) / (layout::kNormalSumFull - layout::kNormalSumNone);
    return {total.normalized(), severed ? 0.0 : std::clamp(clear, 0.0, 1.0)};
  }

  const Lattice& lattice_;
  const std::vector<layout::vec4>& displacement_m_;
  const std::vector<layout::NodeBits>& nodes_;
  Bases bases_;
  bool normals_by_sum_;
};

}  // namespace viscera::testing
