// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/thread/thread_blades.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "model/scene/tool_kinds.h"

namespace viscera {

namespace {

bool cuts(const StylusMotion& motion) {
  return motion.present && motion.mode == ToolMode::kCut && !(motion.feels_m > 0);
}

/// By signed volumes: what passes exactly through a border meets.
bool pierces(const std::array<Vector3d, 2>& edge, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d way = edge[1] - edge[0];
  const auto side = [&](const Vector3d& from, const Vector3d& to) {
    return way.cross(from - edge[0]).dot(to - edge[0]);
  };
  const double ab = side(a, b), bc = side(b, c), ca = side(c, a);
  const bool through = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  const Vector3d normal = (b - a).cross(c - a);
  const double first = normal.dot(edge[0] - a), second = normal.dot(edge[1] - a);
  return through && normal.squaredNorm() > 0 && (first <= 0) != (second <= 0);
}

}  // namespace

bool edgeMeets(const std::array<Vector3d, 2>& edge, const std::array<Vector3d, 2>& from,
               const std::array<Vector3d, 2>& to) {
  return pierces(edge, from[0], from[1], to[1]) || pierces(edge, from[0], to[1], to[0]);
}

bool ThreadBlades::beginTick(const ToolMotions& motions) {
  motions_ = motions;
  before_m_.clear();
  any_ = std::any_of(motions.begin(), motions.end(), cuts);
  return any_;
}

std::vector<size_t> ThreadBlades::met(size_t thread, const std::vector<Vector3d>& places_m) const {
  std::vector<size_t> out;
  if (!any_) return out;
  const std::vector<Vector3d>& before_m = before_m_[thread];
  for (size_t s = 0; s < styluses_.size(); ++s) {
    if (!cuts(motions_[s])) continue;
    const BladeSpan span = bladeSpan(styluses_[s].cut);
    const std::array<Vector3d, 2> edge = {Vector3d(0, 0, span.low_m), Vector3d(0, 0, span.high_m)};
    const Pose from = motions_[s].from.inverse(), to = motions_[s].to.inverse();
    for (size_t i = 0; i + 1 < places_m.size(); ++i) {
      if (edgeMeets(edge, {from * before_m[i], from * before_m[i + 1]}, {to * places_m[i], to * places_m[i + 1]}))
        out.push_back(i);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace viscera
