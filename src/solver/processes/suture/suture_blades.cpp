// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_blades.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "model/scene/tool_kinds.h"
#include "tools/scissors_edge.h"

namespace viscera {

namespace {

/// An edge, fixed in a moving frame.
struct MovedEdge {
  std::array<Vector3d, 2> ends;
  Pose from, to;
};

/// Returns the edge with which a stylus cuts sutures in a tick; nothing: it does not.
std::optional<MovedEdge> edgeOf(const StylusMotion& motion, const StylusConfig& config) {
  const ToolKind& kind = kindOf(motion.mode);
  if (!motion.present || !kind.does(kCuts)) return std::nullopt;
  if (!kind.closes) {
    const BladeSpan span = bladeSpan(config.cut);
    return MovedEdge{{Vector3d(0, 0, span.low_m), Vector3d(0, 0, span.high_m)}, motion.from, motion.to};
  }
  if (motion.opens_from_rad <= motion.opens_to_rad) return std::nullopt;
  const Scissors scissors = scissorsOf(config.scissors);
  const auto crossing = [&](double opening_rad) {
    return Pose{Vector3d(0, 0, scissors.length_m - crossing_m(scissors, opening_rad)), Quaterniond::Identity()};
  };
  const double half_m = scissors.length_m * std::tan(0.5 * motion.mouth_rad);
  return MovedEdge{{Vector3d(-half_m, 0, 0), Vector3d(half_m, 0, 0)},
                   motion.from * crossing(motion.opens_from_rad),
                   motion.to * crossing(motion.opens_to_rad)};
}

/// Tests by signed volumes; passing exactly through a border counts.
bool pierces(const std::array<Vector3d, 2>& edge, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d offset = edge[1] - edge[0];
  const auto side = [&](const Vector3d& from, const Vector3d& to) {
    return offset.cross(from - edge[0]).dot(to - edge[0]);
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

bool SutureBlades::beginTick(const ToolMotions& motions) {
  motions_ = motions;
  before_m_.clear();
  any_ = false;
  for (size_t i = 0; i < styluses_.size(); ++i) any_ = any_ || edgeOf(motions[i], styluses_[i]);
  return any_;
}

std::vector<size_t> SutureBlades::met(size_t suture, const std::vector<Vector3d>& positions_m) const {
  std::vector<size_t> out;
  if (!any_) return out;
  const std::vector<Vector3d>& before_m = before_m_[suture];
  for (size_t s = 0; s < styluses_.size(); ++s) {
    const std::optional<MovedEdge> edge = edgeOf(motions_[s], styluses_[s]);
    if (!edge) continue;
    const Pose from = edge->from.inverse(), to = edge->to.inverse();
    for (size_t i = 0; i + 1 < positions_m.size(); ++i) {
      if (edgeMeets(edge->ends, {from * before_m[i], from * before_m[i + 1]},
                    {to * positions_m[i], to * positions_m[i + 1]}))
        out.push_back(i);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace viscera
