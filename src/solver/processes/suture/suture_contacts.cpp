// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_contacts.h"

#include <algorithm>
#include <utility>

#include "math/vec4.h"
namespace viscera {

namespace {

constexpr double kReachSteps = 2;  // nodes are near an obstacle within their displacement in this many substeps
constexpr double kDeep = 2;    // radii of the suture: from deeper inside, the normal is taken where the node came from
constexpr double kSunk = 0.5;  // radii from an obstacle: a known contact with a nearer node is violated
constexpr int kMostLaid = 4;   // times in a substep

ObstacleSide fromCentre(const Vector3d& from, double radius_m) {
  const double length_m = from.norm();
  return {length_m - radius_m, length_m > 0 ? Vector3d(from / length_m) : Vector3d::UnitZ()};
}

ObstacleSide fromBox(const Vector3d& at, const Vector3d& half) {
  const Vector3d beyond = at.cwiseAbs() - half;
  if ((beyond.array() > 0).any()) return fromCentre(at - at.cwiseMin(half).cwiseMax(-half), 0);
  Vector3d::Index axis;
  const double deepest_m = beyond.maxCoeff(&axis);
  Vector3d normal = Vector3d::Zero();
  normal[axis] = at[axis] < 0 ? -1 : 1;
  return {deepest_m, normal};
}

/// Returns the side in the obstacle's own frame.
ObstacleSide nearestOf(const layout::ObstacleMotion& obstacle, const Vector3d& at) {
  const double radius_m = obstacle.from.w, half_m = obstacle.to.w;
  switch (obstacle.info.x) {
    case layout::kShapePlane:
      return {at.z(), Vector3d::UnitZ()};
    case layout::kShapeSphere:
      return fromCentre(at, radius_m);
    case layout::kShapeCapsule:
      return fromCentre(at - std::clamp(at.z(), -half_m, half_m) * Vector3d::UnitZ(), radius_m);
    default:
      return fromBox(at, xyz(obstacle.half_size));
  }
}

/// Sets a touch to the tangent plane near a position. @param at  the position
void lay(ChainTouch& touch, const layout::ObstacleMotion& obstacle, const Vector3d& at, const ObstacleSide& nearest,
         double dt_s) {
  touch.normal = nearest.normal;
  touch.at_m = at - nearest.distance_m * touch.normal;
  touch.moved_m = dt_s * (xyz(obstacle.velocity) + xyz(obstacle.spin).cross(at - xyz(obstacle.to)));
  touch.friction = obstacle.velocity.w;
}

std::pair<uint32_t, uint32_t> numberOf(const ChainTouch& touch) {
  return {touch.node, touch.thing};
}

bool earlier(const ChainTouch& touch, const std::pair<uint32_t, uint32_t>& number) {
  return numberOf(touch) < number;
}

}  // namespace

ObstacleSide sideOf(const layout::ObstacleMotion& obstacle, const Vector3d& position_m) {
  const layout::vec4& q = obstacle.to_orientation;
  const Quaterniond turn(q.w, q.x, q.y, q.z);
  const ObstacleSide own = nearestOf(obstacle, turn.conjugate() * (position_m - xyz(obstacle.to)));
  return {own.distance_m, turn * own.normal};
}

void SutureContacts::find(const Chain& chain, const layout::ObstacleMotion* obstacles, uint32_t count,
                          const NearTracks& beside, double dt_s, std::vector<ChainTouch>& touches) {
  laid_ = 0;
  before_.swap(touches);
  touches.clear();
  auto kept = before_.cbegin();
  for (uint32_t node = 0; node < chain.nodes(); ++node) {
    const Vector3d offset = dt_s * chain.velocities_m_per_s()[node], ahead = chain.positions_m()[node] + offset;
    const double reach_m = chain.material().radius_m + chain.link_m() + kReachSteps * offset.norm();
    for (uint32_t thing = 0; thing < count; ++thing) {
      Vector3d at = ahead;
      ObstacleSide nearest = sideOf(obstacles[thing], at);
      if (nearest.distance_m > reach_m) continue;
      if (nearest.distance_m < -kDeep * chain.material().radius_m) {
        at = chain.positions_m()[node];
        nearest = sideOf(obstacles[thing], at);
      }
      touches.push_back(knownAs({node, thing}, kept));
      lay(touches.back(), obstacles[thing], at, nearest, dt_s);
    }
    if (!beside.skin || (node > beside.low - 1 && node < beside.high + 1)) continue;
    std::optional<ChainTouch> on_skin = beside.skin->near(ahead, reach_m, dt_s);
    if (!on_skin) continue;
    const ChainTouch known = knownAs({node, on_skin->thing}, kept);
    on_skin->node = node;
    on_skin->rub_kg = known.rub_kg;
    on_skin->closed = known.closed;
    touches.push_back(*on_skin);
  }
}

/// Returns the contact of the last substep, if there was one. @param kept  advances in before_
ChainTouch SutureContacts::knownAs(const Number& number, std::vector<ChainTouch>::const_iterator& kept) const {
  kept = std::lower_bound(kept, before_.cend(), number, earlier);
  if (kept != before_.cend() && numberOf(*kept) == number) return *kept;
  ChainTouch touch;
  touch.node = number.first;
  touch.thing = number.second;
  return touch;
}

bool SutureContacts::catchUp(const Chain& chain, const layout::ObstacleMotion* obstacles, uint32_t count, double dt_s,
                             const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches) {
  bool any = false, deep = false;
  for (uint32_t node = 0; node < chain.nodes(); ++node) {
    for (uint32_t thing = 0; thing < count; ++thing) {
      const double distance_m = sideOf(obstacles[thing], ends_m[node]).distance_m;
      if (distance_m > chain.material().radius_m) continue;
      const Number number{node, thing};
      const auto position = std::lower_bound(touches.begin(), touches.end(), number, earlier);
      if (position != touches.end() && numberOf(*position) == number) {
        deep |= distance_m < kSunk * chain.material().radius_m;
        continue;
      }
      ChainTouch touch;
      touch.node = node;
      touch.thing = thing;
      touch.closed = true;
      const Vector3d& from = chain.positions_m()[node];
      lay(touch, obstacles[thing], from, sideOf(obstacles[thing], from), dt_s);
      touches.insert(position, touch);
      any = true;
    }
  }
  return (deep && layAgain(chain, obstacles, count, dt_s, ends_m, touches)) || any;
}

/// Places contacts again. The half spaces of a suture that flies around an obstacle may require more length than there
/// is, and press it in elsewhere.
bool SutureContacts::layAgain(const Chain& chain, const layout::ObstacleMotion* obstacles, uint32_t count, double dt_s,
                              const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches) {
  if (laid_++ == kMostLaid) return false;
  for (ChainTouch& touch : touches) {
    if (!touch.closed || touch.thing >= count) continue;
    Vector3d at = ends_m[touch.node];
    ObstacleSide nearest = sideOf(obstacles[touch.thing], at);
    if (nearest.distance_m < -kDeep * chain.material().radius_m) {
      at = chain.positions_m()[touch.node];
      nearest = sideOf(obstacles[touch.thing], at);
    }
    lay(touch, obstacles[touch.thing], at, nearest, dt_s);
  }
  return true;
}

}  // namespace viscera
