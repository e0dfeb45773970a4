// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/reference_environment.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "layout/touch_depths.h"
#include "solver/contact/collision.h"
#include "solver/contact/environment.h"
#include "solver/contact/node_pairs.h"
#include "solver/reference/reference_solver.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

ReferenceEnvironment::ReferenceEnvironment(const Model& model, const Scene& scene)
    : wind_(scene.environment.wind),
      collision_(scene.collision),
      touch_depths_m_(touchDepths(model, scene.collision)),
      around_(model.slots()) {
  const ReferenceLattice masses(model);
  const bool blows = environmentOf(model, scene).wind;  // without wind there is no air, so it does not brake either
  int64_t first_spring = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const uint32_t first = model.slotOffset(b);
    double mass = 0;
    for (const uint32_t local : body.lattice.active_slots) mass += masses.mass(first + local);
    // The float32 numbers that kernels get.
    const Vector3f acceleration = (body.force_n / mass).cast<float>();
    acceleration_m_per_s2_.push_back(body.force_n == Vector3d::Zero() ? Vector3d::Zero()
                                                                      : acceleration.cast<double>().eval());
    distance_m_.push_back(static_cast<float>(collisionDistance(body, scene.collision)));
    body_.insert(body_.end(), body.lattice.nodes.size(), b);
    if (!body.network || !blows) continue;
    std::map<std::array<uint32_t, 2>, int64_t> springs;
    for (size_t s = 0; s < body.network->springs.size(); ++s) {
      const auto& spring = body.network->springs[s];
      springs.insert(
          {{std::min(spring.a, spring.b), std::max(spring.a, spring.b)}, first_spring + static_cast<int64_t>(s)});
    }
    for (const std::array<uint32_t, 3>& t : body.network->triangles) {
      Triangle triangle{{first + t[0], first + t[1], first + t[2]}, {-1, -1, -1}};
      for (size_t e = 0; e < 3; ++e) {
        const uint32_t p = t[e], q = t[(e + 1) % 3];
        const auto found = springs.find({std::min(p, q), std::max(p, q)});
        if (found != springs.end()) triangle.springs[e] = found->second;
      }
      for (const uint32_t corner : triangle.slots) around_[corner].push_back(triangle);
    }
    first_spring += static_cast<int64_t>(body.network->springs.size());
  }
}

/// Returns a third of the area of the whole triangles around a node, as a vector along the normals [m2].
Vector3d ReferenceEnvironment::areaAround(const ReferenceLattice& lattice, const Field& u_m, uint32_t slot) const {
  const auto at = [&](uint32_t corner) { return Vector3d(lattice.restPosition(corner) + u_m[corner]); };
  Vector3d sum = Vector3d::Zero();
  for (const Triangle& t : around_[slot]) {
    const bool torn = std::any_of(t.springs.begin(), t.springs.end(), [&](int64_t spring) {
      return spring >= 0 && lattice.spring_cut[static_cast<size_t>(spring)] > 0;
    });
    if (torn) continue;
    sum += (at(t.slots[1]) - at(t.slots[0])).cross(at(t.slots[2]) - at(t.slots[0])) / 6;
  }
  return sum;
}

Vector3d ReferenceEnvironment::kick(const ReferenceLattice& lattice, const Field& u_m, const Vector3d& v_m_per_s,
                                    const Vector3d& wind_m_per_s, double dt_s, uint32_t slot) const {
  Vector3d out = dt_s * acceleration_m_per_s2_[body_[slot]];
  if (around_[slot].empty()) return out;
  const Vector3d area = areaAround(lattice, u_m, slot);
  if (area.norm() == 0) return out;
  const Vector3d normal = area.normalized();
  const double across = (wind_m_per_s - v_m_per_s).dot(normal);
  const double pressure = 0.5 * wind_.air_density_kg_per_m3 * wind_.drag_coefficient * std::abs(across);
  return out + std::min(1.0, pressure * area.norm() * dt_s / lattice.mass(slot)) * across * normal;
}

bool ReferenceEnvironment::mayTouch(const ReferenceLattice& lattice, uint32_t slot) const {
  const float depth_m = touch_depths_m_[slot];
  if (lattice.isIsolated(slot) || depth_m == layout::kNeverTouches) return false;
  return depth_m != layout::kTouchesOnceCut || (lattice.nodes[slot].lo & layout::kSeveredBit) != 0;
}

/// Returns the distance that two nodes keep if they may touch [m]: surfaces keep that of their bodies, and the nodes
/// are below them.
double ReferenceEnvironment::distanceBetween(const ReferenceLattice& lattice, uint32_t a, uint32_t b) const {
  double out = std::max(distance_m_[body_[a]], distance_m_[body_[b]]);
  for (const uint32_t slot : {a, b}) {
    if (touch_depths_m_[slot] != layout::kTouchesOnceCut) out += touch_depths_m_[slot];
  }
  if (body_[a] != body_[b]) return out;
  return std::min(out, (lattice.restPosition(a) - lattice.restPosition(b)).norm() / 2);
}

std::vector<ReferenceEnvironment::Pair> ReferenceEnvironment::touching(const ReferenceLattice& lattice,
                                                                       const Field& u_m, double widened) const {
  double deepest = 0;
  for (const float depth_m : touch_depths_m_) {
    if (depth_m != layout::kTouchesOnceCut) deepest = std::max<double>(deepest, depth_m);
  }
  const double reach = widened * (*std::max_element(distance_m_.begin(), distance_m_.end()) + 2 * deepest);
  using Cell = std::array<long, 3>;
  const auto cellOf = [reach](const Vector3d& x) {
    return Cell{std::lround(x.x() / reach), std::lround(x.y() / reach), std::lround(x.z() / reach)};
  };
  std::map<Cell, std::vector<uint32_t>> cells;
  const auto at = [&](uint32_t slot) { return Vector3d(lattice.restPosition(slot) + u_m[slot]); };
  for (const uint32_t slot : lattice.active) {
    if (mayTouch(lattice, slot)) cells[cellOf(at(slot))].push_back(slot);
  }
  std::vector<Pair> out;
  const auto visit = [&](uint32_t a, uint32_t b) {
    if (a >= b) return;
    const double wanted = widened * distanceBetween(lattice, a, b);
    if ((at(a) - at(b)).norm() < wanted) out.push_back({a, b, wanted});
  };
  for (const auto& [cell, slots] : cells) {
    for (int i = 0; i < 27; ++i) {
      const auto other = cells.find({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1});
      if (other == cells.end()) continue;
      for (const uint32_t a : slots) {
        for (const uint32_t b : other->second) visit(a, b);
      }
    }
  }
  std::sort(out.begin(), out.end(), [](const Pair& p, const Pair& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
  return out;
}

// ---- effects on the state ----

/// @param offset_m  grows by the change of displacement in the substep due to the velocities; null: the integrator
/// continues from them
void ReferenceSolver::blow(const SubstepOutside& outside, const Field& u, Field& v, Field* offset_m) {
  if (!options_.environment) return;
  const Field u_now = u;
  for (uint32_t slot : active) {
    if (isFixed(nodes[slot]) || isIsolated(slot)) continue;
    const Vector3d kick = options_.environment->kick(*this, u_now, v[slot], outside.wind_m_per_s, dt_s_, slot);
    if (const uint32_t held_by = heldBy(slot)) {
      impulse_n_s[held_by - 1] -= mass(slot) * kick;
      continue;
    }
    v[slot] += kick;
    if (offset_m) (*offset_m)[slot] += dt_s_ * kick;
  }
}

void ReferenceSolver::meetObstacles(Field& u_next, Field& v_next) {
  for (uint32_t slot : active) {
    if (rests(slot) || isGhost(nodes[slot]) || heldBy(slot) != 0) continue;
    const Vector3d rest = restPosition(slot), x = rest + u_m[slot];
    for (size_t o = 0; o < obstacles_.size(); ++o) {
      const ReferenceObstacle obstacle = obstacles_[o].enlarged(surfaceDepth(slot));
      const std::optional<ObstacleMeeting> met = obstacle.meet(x, rest + u_next[slot]);
      if (!met) continue;
      const Vector3d out = met->surface_m - (rest + u_next[slot]);
      const double most = std::max(options_.push_speed_m_per_s * dt_s_, 1.001 * met->offset_m);
      u_next[slot] += std::min(1.0, out.norm() > 0 ? most / out.norm() : 1.0) * out;
      const Vector3d relative = v_next[slot] - obstacle.velocityAt(rest + u_next[slot]);
      const double approach = -relative.dot(met->normal);
      if (approach <= 0) continue;
      const double change = approach > restingSpeed() ? (1 + obstacle.restitution()) * approach : approach;
      const Vector3d sliding = relative + approach * met->normal;
      const double loses = std::min(obstacle.friction() * change, sliding.norm());
      const Vector3d friction = sliding.norm() > 0 ? Vector3d(-loses * sliding.normalized()) : Vector3d::Zero();
      v_next[slot] += change * met->normal + friction;
      u_next[slot] += dt_s_ * friction;
      // Leapfrog's drag, in the middle of the kick, reduces an impulse by this factor.
      const double through = 1 / (1 + 0.5 * mass_damping_per_s(slot) * dt_s_);
      obstacle_impulse_n_s[o] += mass(slot) * (change * met->normal + friction) / through;
    }
  }
}

namespace {

Vector3d apart(const ReferenceLattice& lattice, const Field& u_m, uint32_t a, uint32_t b) {
  return lattice.restPosition(a) + u_m[a] - lattice.restPosition(b) - u_m[b];
}

}  // namespace

ContactNormals::ContactNormals(const ReferenceLattice& lattice, const std::vector<ReferenceEnvironment::Pair>& pairs,
                               const Field& before_m, const Field& now_m)
    : lattice_(lattice), before_m_(before_m), now_m_(now_m), touched_(lattice.slots()) {
  for (const auto& pair : pairs) {
    const Vector3d weighted =
        (pair.distance_m - apart(lattice, now_m, pair.a, pair.b).norm()) * direction(pair.a, pair.b);
    touched_[pair.a].direction += weighted;
    touched_[pair.b].direction -= weighted;
    ++touched_[pair.a].contacts;
    ++touched_[pair.b].contacts;
  }
}

/// Returns the direction from b to a before the substep.
Vector3d ContactNormals::direction(uint32_t a, uint32_t b) const {
  for (const Vector3d& d : {apart(lattice_, before_m_, a, b), apart(lattice_, now_m_, a, b)}) {
    if (d.norm() > 0) return d.normalized();
  }
  return Vector3d::UnitZ();
}

/// Returns the normal of the sheet on which one of the two rests: the mean direction of the contacts of the node that
/// has more.
Vector3d ContactNormals::of(const ReferenceEnvironment::Pair& pair) const {
  constexpr double kLeast = 0.05;  // cosine to the contact's own direction: a mean at a larger angle is not a normal
  const Touched &a = touched_[pair.a], &b = touched_[pair.b];
  const Vector3d toward = direction(pair.a, pair.b);
  Vector3d mean = Vector3d::Zero();
  if (a.contacts >= b.contacts) mean += a.direction;
  if (b.contacts >= a.contacts) mean -= b.direction;
  return mean.norm() > 0 && mean.dot(toward) > kLeast * mean.norm() ? mean.normalized().eval() : toward;
}

void ReferenceSolver::collide(Field& u_next, Field& v_next) {
  if (!options_.environment || !options_.environment->collides()) return;
  const CollisionConfig& config = options_.environment->collision();
  const bool implicit = options_.integrator == ReferenceIntegrator::kImplicitEuler;
  const auto pairs = options_.environment->touching(*this, u_next, implicit ? static_cast<double>(kMissedReach) : 1.0);
  const ContactNormals normals(*this, pairs, u_m, u_next);
  const auto inverseMass = [this](uint32_t slot) {
    return isFixed(nodes[slot]) || heldBy(slot) != 0 ? 0 : 1 / mass(slot);
  };
  Field impulse(slots(), Vector3d::Zero()), shift(slots(), Vector3d::Zero());
  for (const auto& [a, b, distance] : pairs) {
    const double inverse = normals.contacts(a) * inverseMass(a) + normals.contacts(b) * inverseMass(b);
    if (inverse == 0) continue;
    const Vector3d normal = normals.of({a, b, distance});
    const double depth = std::max(0.0, distance - apart(*this, u_m, a, b).norm());
    const Vector3d moved = std::min(0.25 * depth, options_.push_speed_m_per_s * dt_s_) / inverse * normal;
    shift[a] += moved;
    shift[b] -= moved;
    const Vector3d relative = v_next[a] - v_next[b];
    const double approach = -relative.dot(normal);
    if (approach <= 0) continue;
    const double came =
        -(v_m_per_s[a] - v_m_per_s[b]).dot(normal);  // before the substep: its forces do not cause bounces
    const double change = came > restingSpeed() ? approach + config.restitution * came : approach;
    const Vector3d sliding = relative + approach * normal;
    Vector3d push = change * normal;
    if (sliding.norm() > 0) push -= std::min(config.friction * change, sliding.norm()) * sliding.normalized();
    impulse[a] += push / inverse;
    impulse[b] -= push / inverse;
  }
  for (uint32_t slot : active) {
    if (isFixed(nodes[slot]) || isIsolated(slot)) continue;
    if (const uint32_t held_by = heldBy(slot)) {
      impulse_n_s[held_by - 1] -= impulse[slot];
      continue;
    }
    v_next[slot] += impulse[slot] / mass(slot);
    u_next[slot] += dt_s_ * impulse[slot] / mass(slot) + shift[slot] / mass(slot);
  }
}

}  // namespace viscera
