// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/arrows.h"

namespace viscera {

namespace {
constexpr int kAcross = 3;  // arrows of the wind along an edge of their square
}

void addForceArrows(const ToolMotions& motions, const std::array<Reaction, layout::kMaxStyluses>& reactions,
                    std::vector<Arrow>& out) {
  for (size_t s = 0; s < motions.size(); ++s) {
    if (!motions[s].present || reactions[s].force_n.isZero()) continue;
    out.push_back({Arrow::Kind::kForce, motions[s].to.position_m, kArrowPerNewton_m * reactions[s].force_n});
  }
}

void addWindArrows(const Vector3d& wind_m_per_s, const Model& model, std::vector<Arrow>& out) {
  if (wind_m_per_s.isZero()) return;
  Eigen::AlignedBox3d box;
  for (const Body& body : model.bodies) {
    for (const Vector3f& point : body.skin.mesh.positions_m) box.extend(point.cast<double>());
  }
  if (box.isEmpty()) return;
  const Vector3d direction = wind_m_per_s.normalized(), along = kArrowOfWind_s * wind_m_per_s;
  const Vector3d u = direction.unitOrthogonal(), v = direction.cross(u);
  const double half = box.diagonal().norm() / 2;
  const Vector3d front = box.center() - half * direction - along;
  for (int i = 0; i < kAcross; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const double a = i - (kAcross - 1) / 2.0, b = j - (kAcross - 1) / 2.0;
      out.push_back({Arrow::Kind::kWind, front + half / kAcross * (a * u + b * v), along});
    }
  }
}

}  // namespace viscera
