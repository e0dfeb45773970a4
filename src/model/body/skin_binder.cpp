// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/skin_binder.h"

#include <algorithm>
#include <optional>

#include "model/body/skin_basis.h"

namespace viscera {

namespace {

layout::vec4 packed(const Vector3d& v) {
  const Vector3f f = v.cast<float>();
  return {f.x(), f.y(), f.z(), 0};
}

Vector3d edgeOf(const Anchor& anchor, size_t node) {
  return (anchor.nodes[node] - anchor.nodes[0]).cast<double>();
}

/// Foot of a vertex on a triangle along the interpolated normal. Offset in spacings, from node 0.
struct NormalFoot {
  double weight1 = 0, weight2 = 0, along = 0;
};

/// Solver of p0 + w1 e1 + w2 e2 + along N(w) = vertex, with N the direction of the weighted normals of the nodes.
/// Newton's method finds the weights; `along` is the offset that brings the vertex to the triangle's plane.
class FootFinder {
 public:
  FootFinder(const Anchor& anchor, const Vector3d& vertex, const std::array<Vector3d, 3>& normals)
      : edge1_(edgeOf(anchor, 1)),
        edge2_(edgeOf(anchor, 2)),
        plane_(edge1_.cross(edge2_)),
        vertex_(vertex),
        normals_(normals) {}

  std::optional<NormalFoot> from(double weight1, double weight2) const {
    constexpr int kSteps = 30;
    constexpr double kStep = 1e-6, kExact = 1e-9;  // in spacings
    Eigen::Vector2d w(weight1, weight2);
    for (int step = 0; step < kSteps; ++step) {
      const Eigen::Vector2d miss = missOf(w);
      if (miss.norm() < kExact) return accepted(w);
      Eigen::Matrix2d slope;
      slope << (missOf(w + Eigen::Vector2d(kStep, 0)) - miss) / kStep,
          (missOf(w + Eigen::Vector2d(0, kStep)) - miss) / kStep;
      if (std::abs(slope.determinant()) < kExact) return std::nullopt;
      w -= slope.inverse() * miss;
      if (!w.allFinite() || w.norm() > 10) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  Vector3d normalAt(const Eigen::Vector2d& w) const {
    return ((1 - w.sum()) * normals_[0] + w.x() * normals_[1] + w.y() * normals_[2]).normalized();
  }
  double alongAt(const Eigen::Vector2d& w) const { return vertex_.dot(plane_) / normalAt(w).dot(plane_); }
  Eigen::Vector2d missOf(const Eigen::Vector2d& w) const {
    const Vector3d foot = vertex_ - alongAt(w) * normalAt(w);
    return Eigen::Vector2d(foot.dot(edge1_), foot.dot(edge2_)) - w;
  }
  /// Rejects weights far from 0..1, which would amplify small motions of the nodes.
  std::optional<NormalFoot> accepted(const Eigen::Vector2d& w) const {
    constexpr double kBeyond = 0.25, kLongest = 2;
    const double along = alongAt(w), least = std::min({w.x(), w.y(), 1 - w.sum()});
    if (least < -kBeyond || std::abs(along) > kLongest) return std::nullopt;
    return NormalFoot{w.x(), w.y(), along};
  }

  Vector3d edge1_, edge2_, plane_, vertex_;
  std::array<Vector3d, 3> normals_;
};

}  // namespace

Vector3d SkinBinder::referenceOf(const Anchor& anchor, const layout::SkinBinding& binding) const {
  return lattice_.restPosition(binding.slot0) +
         lattice_.spacing_m * (binding.weights.y * edgeOf(anchor, 1) + binding.weights.z * edgeOf(anchor, 2));
}

layout::SkinBinding SkinBinder::bind(const Anchor& anchor, const Vector3d& position_m, const Vector3d& normal) const {
  if (mapping_ == Mapping::kAlongNormal) return bindAlongNormal(anchor, position_m, normal);
  if (mapping_ != Mapping::kOneToOne) return bindToTriangle(anchor, position_m, normal);
  layout::SkinBinding binding = bindToTriangle(atNearestNode(anchor), position_m, normal);
  binding.springs |= layout::kOneNodeBit;
  return binding;
}

bool SkinBinder::isAsAsked(const layout::SkinBinding& binding) const {
  if (mapping_ == Mapping::kInterpolated) return (binding.springs & layout::kInterpolatedBit) != 0;
  if (mapping_ == Mapping::kAlongNormal) return (binding.springs & layout::kAlongNormalBit) != 0;
  return true;
}

layout::SkinBinding SkinBinder::bindToTriangle(const Anchor& anchor, const Vector3d& position_m,
                                               const Vector3d& normal) const {
  layout::SkinBinding binding{};
  binding.slot0 = slotOf(anchor.nodes[0]);
  binding.slot1 = slotOf(anchor.nodes[1]);
  binding.slot2 = slotOf(anchor.nodes[2]);
  for (int edge = 0; edge < 3; ++edge) {
    const int spring = springIndex(anchor.nodes[(edge + 1) % 3] - anchor.nodes[edge]);
    binding.springs |= static_cast<uint32_t>(spring) << (5 * edge);
  }
  if (anchor.cell) {
    const Vector3i corner = anchor.nodes[0] - *anchor.cell;
    const int number = corner.x() + 2 * corner.y() + 4 * corner.z();
    binding.springs |= layout::kInCellBit | static_cast<uint32_t>(number) << layout::kCornerShift;
  }
  const float weight1 = static_cast<float>(anchor.weight1), weight2 = static_cast<float>(anchor.weight2);
  binding.weights = {1 - weight1 - weight2, weight1, weight2, 0};
  // The offset is measured from the reference point of the rounded weights, so that the sum is exact.
  const Vector3d offset = position_m - referenceOf(anchor, binding);
  const SkinBasis constant = triangleBasis(edgeOf(anchor, 1), edgeOf(anchor, 2));
  binding.offset_constant = packed(constant.coordinates(offset));
  binding.normal_constant = packed(constant.coordinates(normal));
  if (mapping_ == Mapping::kAuto || mapping_ == Mapping::kInterpolated) {
    if (const auto curved =
            interpolatedBasis(lattice_, {binding.slot0, binding.slot1, binding.slot2}, binding.weights, constant)) {
      binding.springs |= layout::kInterpolatedBit;
      binding.offset_interpolated = packed(curved->coordinates(offset));
      binding.normal_interpolated = packed(curved->coordinates(normal));
    }
  }
  return binding;
}

/// Moves the reference point until the offset is along the normal there (EGVE 3.5).
layout::SkinBinding SkinBinder::bindAlongNormal(const Anchor& anchor, const Vector3d& position_m,
                                                const Vector3d& normal) const {
  const std::array<uint32_t, 3> slots = {slotOf(anchor.nodes[0]), slotOf(anchor.nodes[1]), slotOf(anchor.nodes[2])};
  const auto weights = [](double weight1, double weight2) {
    return layout::vec4{static_cast<float>(1 - weight1 - weight2), static_cast<float>(weight1),
                        static_cast<float>(weight2), 0};
  };
  const SkinBasis constant = triangleBasis(edgeOf(anchor, 1), edgeOf(anchor, 2));
  if (!interpolatedBasis(lattice_, slots, weights(anchor.weight1, anchor.weight2), constant))
    return bindToTriangle(anchor, position_m, normal);
  std::array<Vector3d, 3> normals;
  for (size_t i = 0; i < 3; ++i) normals[i] = neighborSum(lattice_, slots[i]).normalized();
  const Vector3d vertex = (position_m - lattice_.restPosition(slots[0])) / lattice_.spacing_m;
  const std::optional<NormalFoot> foot = FootFinder(anchor, vertex, normals).from(anchor.weight1, anchor.weight2);
  if (!foot || !interpolatedBasis(lattice_, slots, weights(foot->weight1, foot->weight2), constant))
    return bindToTriangle(anchor, position_m, normal);
  Anchor moved = anchor;
  moved.weight1 = foot->weight1;
  moved.weight2 = foot->weight2;
  layout::SkinBinding binding = bindToTriangle(moved, position_m, normal);
  binding.springs |= layout::kAlongNormalBit;
  binding.weights.w = static_cast<float>(lattice_.spacing_m * foot->along);
  return binding;
}

}  // namespace viscera
