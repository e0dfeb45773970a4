// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/anchor_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace viscera {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

/// Surface point that a viewer along -z sees.
struct Skinned {
  double height_m = kNone;  ///< kNone: no surface
  double back_m = kNone;    ///< of the far side of the tissue there; kNone: not known
  bool is_held = false;
  double thickness_m() const { return back_m == kNone ? 0 : std::max(0.0, height_m - back_m); }
};

/// How well a place suits strokes, by their positions with the surface below them.
class Met {
 public:
  /// @param deepest_m  of the strokes: tissue below it does not matter
  explicit Met(double deepest_m) : deepest_m_(deepest_m) {}
  bool operator<(const Met& other) const { return key() < other.key(); }
  void add(const Skinned& skin) {
    free_ += skin.is_held ? 0 : 1;
    ++all_;
    thickness_m_ += std::min(skin.thickness_m(), deepest_m_);
  }

 private:
  /// Returns the number of positions where tissue can move, of all, and the mean thickness in tenths of the depth.
  std::array<size_t, 3> key() const {
    constexpr double kTenths = 10, kRounding = 1e-6;
    const double most_m = deepest_m_ * static_cast<double>(all_);
    return {free_, all_, most_m > 0 ? static_cast<size_t>(kTenths * thickness_m_ / most_m + kRounding) : 0};
  }
  size_t free_ = 0, all_ = 0;
  double thickness_m_ = 0, deepest_m_;
};

/// Heights of the surfaces for a viewer along -z, on a grid of points across.
class HeightMap {
 public:
  HeightMap(const Model& model, const Quaterniond& to_anchor) {
    for (const Body& body : model.bodies)
      for (const Vector3f& p : body.skin.mesh.positions_m) box_m_.extend(to_anchor * p.cast<double>());
    step_m_ = std::max(box_m_.sizes().x(), box_m_.sizes().y()) / (kPoints - 1);
    skins_.assign(kPoints * kPoints, {});
    if (step_m_ <= 0) return;
    for (const Body& body : model.bodies) {
      const TriangleMesh& mesh = body.skin.mesh;
      const auto at = [&](uint32_t vertex) -> Vector3d { return to_anchor * mesh.positions_m[vertex].cast<double>(); };
      for (const auto& t : mesh.triangles) {
        const bool is_held = std::any_of(t.begin(), t.end(), [&](uint32_t vertex) { return isHeld(body, vertex); });
        add(at(t[0]), at(t[1]), at(t[2]), is_held);
      }
    }
  }

  Skinned at(double x_m, double y_m) const {
    const Vector3d cell = (Vector3d(x_m, y_m, 0) - box_m_.min()) / step_m_;
    const double column = std::round(cell.x()), row = std::round(cell.y());
    if (!(column >= 0 && row >= 0 && column < kPoints && row < kPoints)) return {};
    return skins_[static_cast<size_t>(row) * kPoints + static_cast<size_t>(column)];
  }
  double step_m() const { return step_m_; }
  static constexpr int kPoints = 96;  ///< along the longer side: strokes span a quarter of an organ

 private:
  void add(const Vector3d& a, const Vector3d& b, const Vector3d& c, bool is_held) {
    const Vector3d ab = b - a, ac = c - a;
    const double area = ab.x() * ac.y() - ab.y() * ac.x();
    if (area == 0) return;
    const Vector3d low = (a.cwiseMin(b).cwiseMin(c) - box_m_.min()) / step_m_;
    const Vector3d high = (a.cwiseMax(b).cwiseMax(c) - box_m_.min()) / step_m_;
    for (int row = static_cast<int>(std::ceil(low.y())); row <= high.y() && row < kPoints; ++row) {
      for (int column = static_cast<int>(std::ceil(low.x())); column <= high.x() && column < kPoints; ++column) {
        const double x = box_m_.min().x() + column * step_m_ - a.x(), y = box_m_.min().y() + row * step_m_ - a.y();
        const double u = (x * ac.y() - y * ac.x()) / area, v = (ab.x() * y - ab.y() * x) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const double height_m = a.z() + u * ab.z() + v * ac.z();
        Skinned& skin = skins_[static_cast<size_t>(row * kPoints + column)];
        if (area < 0) skin.back_m = std::max(skin.back_m, height_m);
        if (height_m <= skin.height_m) continue;
        skin.height_m = height_m;
        skin.is_held = is_held;
      }
    }
  }

  Eigen::AlignedBox3d box_m_;
  double step_m_ = 0;
  std::vector<Skinned> skins_;  ///< [rows][columns]
};

}  // namespace

bool isHeld(const Body& body, uint32_t vertex) {
  const layout::SkinBinding& binding = body.skin.bindings[vertex];
  const auto is_held = [&](uint32_t slot) { return isFixed(body.lattice.nodes[slot]); };
  return is_held(binding.slot0) && is_held(binding.slot1) && is_held(binding.slot2);
}

Quaterniond frameAlong(const Vector3d& back) {
  const Vector3d up = std::abs(back.z()) < 1 - 1e-6 ? Vector3d::UnitZ() : Vector3d::UnitY();
  Eigen::Matrix3d axes;
  axes.col(2) = back;
  axes.col(0) = up.cross(back).normalized();
  axes.col(1) = back.cross(axes.col(0));
  return Quaterniond(axes);
}

Vector3d shiftOntoSkin(const Model& model, const Anchor& anchor, const std::vector<Vector3d>& spots_m) {
  constexpr double kSlope = 0.6;  // share of the spots' reach: a steeper surface is out of a blade's reach
  const Quaterniond frame = frameAlong((anchor.from_m - anchor.towards_m).normalized());
  const HeightMap map(model, frame.conjugate());
  if (map.step_m() <= 0) return Vector3d::Zero();
  const Vector3d origin = frame.conjugate() * anchor.from_m;
  double reach_m = 0, deepest_m = 0;
  for (const Vector3d& spot : spots_m) {
    reach_m = std::max(reach_m, spot.head<2>().norm());
    deepest_m = std::max(deepest_m, -spot.z());
  }
  const auto met = [&](double x_m, double y_m) {
    const Skinned middle = map.at(x_m, y_m);
    Met count(deepest_m);
    if (middle.height_m != kNone) count.add(middle);
    for (const Vector3d& spot : spots_m) {
      const Skinned skin = map.at(x_m + spot.x(), y_m + spot.y());
      if (std::abs(skin.height_m - middle.height_m) <= kSlope * reach_m) count.add(skin);
    }
    return count;
  };
  Met most = met(origin.x(), origin.y());
  Vector3d shift = Vector3d::Zero();
  for (int row = -HeightMap::kPoints; row <= HeightMap::kPoints; ++row) {
    for (int column = -HeightMap::kPoints; column <= HeightMap::kPoints; ++column) {
      const Vector3d by(column * map.step_m(), row * map.step_m(), 0);
      const Met count = met(origin.x() + by.x(), origin.y() + by.y());
      if (count < most || (!(most < count) && by.norm() >= shift.norm())) continue;
      most = count;
      shift = by;
    }
  }
  return frame * shift;
}

}  // namespace viscera
