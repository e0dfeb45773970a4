// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Effects of styluses on the reference (VR05 2.7, physics.md 5).
#include <algorithm>
#include <cmath>
#include <optional>

#include "layout/edge_nodes.h"
#include "math/vec4.h"
#include "solver/reference/reference_obstacle.h"
#include "solver/reference/reference_solver.h"

namespace viscera {

namespace {

const double kErasedFraction = static_cast<double>(layout::kErasedShare);  ///< of a spring with an erased end

constexpr double kOverlap = 1e-3;  ///< overlap of a sweep with the previous one (shaders/solver/tools/blade.glsl)

Vector3d nearestOnSegment(const Vector3d& a, const Vector3d& b, const Vector3d& x) {
  const Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0 ? Vector3d(a + std::clamp((x - a).dot(ab) / length2, 0.0, 1.0) * ab) : a;
}

struct Plane {
  Vector3d point, normal;
};

/// Returns the plane of the triangle p q r if the segment a..b crosses the triangle, including its border.
std::optional<Plane> crossing(const Vector3d& a, const Vector3d& b, const Vector3d& p, const Vector3d& q,
                              const Vector3d& r) {
  const Vector3d normal = (q - p).cross(r - p);
  if (normal.isZero(0)) return std::nullopt;
  const double da = (a - p).dot(normal), db = (b - p).dot(normal);
  if ((da >= 0) == (db >= 0)) return std::nullopt;
  const double fraction = da / (da - db);
  const Vector3d x = a + fraction * (b - a);
  const bool inside = (q - p).cross(x - p).dot(normal) >= 0 && (r - q).cross(x - q).dot(normal) >= 0 &&
                      (p - r).cross(x - r).dot(normal) >= 0;
  return inside ? std::optional(Plane{p, normal}) : std::nullopt;
}

/// Returns where the line a..b crosses a plane, 0..1 from a to b; clamped to the nearer end.
double fractionOf(const Vector3d& a, const Vector3d& b, const Plane& plane) {
  const double da = (a - plane.point).dot(plane.normal), db = (b - plane.point).dot(plane.normal);
  return da == db ? 0.5 : std::clamp(da / (da - db), 0.0, 1.0);
}

double distanceToTriangle(const Vector3d& x, const Vector3d& p, const Vector3d& q, const Vector3d& r) {
  double d = std::min({(x - nearestOnSegment(p, q, x)).norm(), (x - nearestOnSegment(q, r, x)).norm(),
                       (x - nearestOnSegment(r, p, x)).norm()});
  const Vector3d normal = (q - p).cross(r - p);
  const bool inside = !normal.isZero(0) && (q - p).cross(x - p).dot(normal) >= 0 &&
                      (r - q).cross(x - q).dot(normal) >= 0 && (p - r).cross(x - r).dot(normal) >= 0;
  return inside ? std::min(d, std::abs((x - p).dot(normal)) / normal.norm()) : d;
}

/// Applies the swept sphere of VR05 2.7.1: out of the final sphere along the radius, out of the swept capsule sideways,
/// by at most longest_push_m.
/// @param below_m  depth of the node below the surface of its tissue: the probe is enlarged by it
void probe(const SweptSphere& m, double below_m, double dt_s, double longest_push_m, const Vector3d& x,
           Vector3d& x_next, Vector3d& v_next) {
  const double radius = std::max(0.0, m.radius_m + below_m);
  const Vector3d from = m.from_m, to = m.to_m, travel = to - from;
  const Vector3d centre = (x_next - to).norm() < kOnSphere * radius ? to : nearestOnSegment(from, to, x_next);
  const Vector3d out = x_next - centre;
  if (out.norm() >= radius) return;
  const Vector3d fallback = (x - centre).norm() > 0 ? Vector3d(x - centre)
                            : travel.norm() > 0     ? Vector3d(-travel)
                                                    : Vector3d::UnitZ();
  const Vector3d normal = (out.norm() > 1e-6 * radius ? out : fallback).normalized();
  const Vector3d push = centre + radius * normal - x_next;
  x_next += std::min(1.0, longest_push_m / push.norm()) * push;
  v_next -= std::min(0.0, (v_next - travel / dt_s).dot(normal)) * normal;
}

/// The blade of one substep, as springs of lattices see it (shaders/solver/tools/cut_sides.glsl).
struct Sweep {
  Vector3d from, far_from, far_to, to;

  Vector3d move() const { return (to - from) + (far_to - far_from); }
  Vector3d normal() const {
    const Vector3d normal = ((far_from - from) + (far_to - to)).cross(move());
    return normal.norm() > 0 ? Vector3d(normal.normalized()) : Vector3d::Zero();
  }
  /// Returns the component of a displacement along the blade's own.
  Vector3d along(const Vector3d& shift) const {
    return move().norm() > 0 ? Vector3d(shift.dot(move()) / move().squaredNorm() * move()) : Vector3d::Zero();
  }
};

constexpr double kSameCut = 0.7, kSway = 0.5, kBeside = 1e-3;  // as in cut_sides.glsl

/// Returns the position of a node moved to its side of the cut.
/// @param side  unit normal towards the node's side; zero: none   @param h_m  spacing
Vector3d onItsSide(const Vector3d& side, const Vector3d& x, const Sweep& sweep, double h_m) {
  const double same = sweep.normal().dot(side);
  if (std::abs(same) < kSameCut) return x;
  const Vector3d normal = same < 0 ? Vector3d(-sweep.normal()) : sweep.normal();
  const double away = (x - sweep.from).dot(normal);
  return away >= 0 || away < -kSway * h_m ? x : Vector3d(x + (kBeside * h_m - away) * normal);
}

}  // namespace

Vector3d ReferenceSolver::heldDisplacement(const layout::ToolMotion& m, uint32_t slot) const {
  const Quaterniond q(m.orientation.w, m.orientation.x, m.orientation.y, m.orientation.z);
  return xyz(m.to) + q * grab_offsets_[slot] - restPosition(slot);
}

void ReferenceSolver::applyTools(const SubstepMotions& motions, uint32_t slot, Vector3d& u_next, Vector3d& v_next) {
  const uint32_t held_by = heldBy(slot);
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
    const layout::ToolMotion& m = motions[s];
    const Vector3d v_before = v_next;
    if (held_by == s + 1) {
      u_next = heldDisplacement(m, slot);
      v_next = (u_next - u_m[slot]) / dt_s_;
    } else if (held_by == 0) {
      Vector3d x_next = restPosition(slot) + u_next;
      const auto meet = [&](const SweptSphere& sphere) {
        probe(sphere, surfaceDepth(slot), dt_s_, options_.push_speed_m_per_s * dt_s_, restPosition(slot) + u_m[slot],
              x_next, v_next);
      };
      if (pushesByTip(m)) meet(tipOf(m));
      if (pushesByShaft(m)) meet(shaftNear(m, x_next));
      u_next = x_next - restPosition(slot);
    }
    impulse_n_s[s] += mass(slot) * (v_next - v_before);
  }
}

/// Returns whether a node is at the surface. Nodes of lattices with all their springs, and no surface near them, are
/// inside.
bool ReferenceSolver::onSkin(uint32_t slot) const {
  if (surfaceDepth(slot) != 0) return true;
  for (uint32_t s = 0; s < springsOf(slot); ++s) {
    if (!isWhole(slot, s)) return true;
  }
  return isNetwork(slot);
}

std::optional<ReferenceSolver::EdgeShift> ReferenceSolver::shiftOfEdge(const layout::ToolMotion& m, bool shaft,
                                                                       uint32_t a, uint32_t b, const Field& u_next,
                                                                       const Field& v_next) const {
  const Vector3d x = restPosition(a) + u_next[a], along = restPosition(b) + u_next[b] - x;
  const std::optional<SweptSphere> sphere = shaft ? shaftNearLine(m, x, along) : tipOf(m);
  if (!sphere) return std::nullopt;
  const Vector3d from = sphere->from_m, to = sphere->to_m, travel = to - from;
  const double share_b = (to - x).dot(along) / along.squaredNorm(), share_a = 1 - share_b;
  if (!(share_b > 0 && share_b < 1)) return std::nullopt;
  const Vector3d axis = (xyz(m.shaft_far_to) - xyz(m.shaft_to)).normalized();
  const double length = shaft ? (along - along.dot(axis) * axis).norm() : along.norm();
  const Vector3d at = x + share_b * along;
  const double seen = sphere->radius_m + share_a * surfaceDepth(a) + share_b * surfaceDepth(b);
  const double wider = std::max(0.0, 1 - length / std::max(seen, 1e-9));
  const double chord = wider > 0 ? wider * share_a * share_b * length * length / (2 * seen) : 0;
  const double radius = std::max(0.0, seen - chord);
  const Vector3d centre = (at - to).norm() < kOnSphere * radius ? to : nearestOnSegment(from, to, at);
  if (at == centre) return std::nullopt;
  const Vector3d normal = (at - centre).normalized(), v = share_a * v_next[a] + share_b * v_next[b] - travel / dt_s_;
  const double inside = radius - (at - centre).norm(), slowest = std::min(inside, 0.0) / dt_s_;
  const double push = std::clamp(inside, 0.0, options_.push_speed_m_per_s * dt_s_);
  const double faster = std::max(slowest - v.dot(normal), 0.0);
  if (push == 0 && faster == 0) return std::nullopt;
  return EdgeShift{{a, b}, {share_a, share_b}, {push, faster}, normal};
}

/// Works in rounds; in each, all springs use the result of the previous one.
void ReferenceSolver::applyEdges(const layout::ToolMotion& m, bool shaft, uint32_t stylus, Field& u_next,
                                 Field& v_next) {
  const auto moves = [&](uint32_t slot) { return !isFixed(nodes[slot]) && heldBy(slot) == 0; };
  for (uint32_t round = 0; round < layout::kEdgeRounds; ++round) {
    std::vector<EdgeShift> shifts;
    std::vector<Array2d> sums(nodes.size(), Array2d::Zero());  // sums of shares times displacements
    for (const uint32_t slot : active) {
      for (uint32_t s = 0; onSkin(slot) && s < springsOf(slot); ++s) {
        const uint32_t far = farEnd(slot, s);
        if (far < slot || !isWhole(slot, s) || isAgainstBending(slot, s) || !onSkin(far)) continue;
        const std::optional<EdgeShift> shift = shiftOfEdge(m, shaft, slot, far, u_next, v_next);
        if (!shift) continue;
        shifts.push_back(*shift);
        for (int end = 0; end < 2; ++end) {
          if (moves(shift->slots[end])) sums[shift->slots[end]] += shift->shares[end] * shift->shifts;
        }
      }
    }
    for (const EdgeShift& shift : shifts) {
      Array2d gives = Array2d::Zero();
      for (int end = 0; end < 2; ++end) gives += shift.shares[end] * sums[shift.slots[end]] / mass(shift.slots[end]);
      for (int end = 0; end < 2; ++end) {
        const uint32_t slot = shift.slots[end];
        if (!moves(slot)) continue;
        const double part = shift.shares[end] / mass(slot);
        if (shift.shifts[0] > 0) u_next[slot] += part * shift.shifts[0] * shift.shifts[0] / gives[0] * shift.normal;
        if (shift.shifts[1] == 0) continue;
        const Vector3d dv = part * shift.shifts[1] * shift.shifts[1] / gives[1] * shift.normal;
        v_next[slot] += dv;
        impulse_n_s[stylus] += mass(slot) * dv;
      }
    }
  }
}

void ReferenceSolver::takeHold(uint32_t stylus, const Pose& pose, double radius_m) {
  for (uint32_t slot : active) {
    if (isFixed(nodes[slot]) || heldBy(slot) != 0 || isIsolated(slot)) continue;
    const Vector3d offset = restPosition(slot) + u_m[slot] - pose.position_m;
    if ((offset + offsetToSurface(u_m, slot)).norm() > radius_m) continue;
    grab_offsets_[slot] = pose.orientation.conjugate() * offset;
    nodes[slot].lo |= (stylus + 1) << layout::kGrabShift;
  }
}

void ReferenceSolver::letGo(uint32_t stylus, const Release& release) {
  if (tickImpulse(stylus).norm() <= release.above_n_s) return;
  for (uint32_t slot : active) {
    if (heldBy(slot) != stylus + 1) continue;
    nodes[slot].lo &= ~layout::kGrabMask;
    const double speed = v_m_per_s[slot].norm();
    if (speed > release.speed_m_per_s) v_m_per_s[slot] *= release.speed_m_per_s / speed;
  }
}

void ReferenceSolver::cut(uint32_t stylus, bool particles) {
  cutWith(motions_[stylus], particles, particles ? std::vector<uint8_t>() : options_.resists);
}

/// @param spared  [bodies] 1 where no spring is cut; empty: no body is spared
void ReferenceSolver::cutWith(const layout::ToolMotion& m, bool particles, const std::vector<uint8_t>& spared) {
  const Vector3d a = xyz(m.from), b = xyz(m.blade_from), c = xyz(m.blade_to), d = xyz(m.to);
  const auto position = [&](uint32_t slot) { return tissueAt(u_m, slot); };
  const auto erased = [&](const Vector3d& x) {
    return std::min(distanceToTriangle(x, a, b, c), distanceToTriangle(x, a, c, d)) <= m.blade_from.w;
  };
  const Sweep sweep = {a, b, c, d};
  const auto seen = [&](uint32_t slot) {
    return onItsSide(cut_sides[slot], position(slot), sweep, body(slot).origin_spacing.w);
  };
  const auto remember = [&](uint32_t slot) {
    Vector3d& side = cut_sides[slot];
    const Vector3d normal = sweep.normal();
    if (std::abs(normal.dot(side)) >= kSameCut) return;
    side = (position(slot) - a).dot(normal) >= 0 ? normal : Vector3d(-normal);
  };
  // Returns where a spring, moved by `way` in the last substep, is severed, if it is. The tissue points of its ends
  // decide whether, the line between the nodes where.
  const auto severed = [&](uint32_t slot, uint32_t far, bool linked, const Vector3d& shift) -> std::optional<double> {
    if (particles) {
      return erased(position(slot)) || erased(position(far)) ? std::optional(kErasedFraction) : std::nullopt;
    }
    const Vector3d x = linked ? position(slot) : seen(slot), y = linked ? position(far) : seen(far);
    const bool rests = sweep.move().norm() == 0;
    const Vector3d overlap = kOverlap * (d - a);
    const Vector3d offset = linked  ? Vector3d(shift - overlap)
                            : rests ? Vector3d::Zero()
                                    : Vector3d(sweep.along(shift) - overlap);
    std::optional<Plane> plane = crossing(x, y, a + offset, b + offset, c);
    if (!plane) plane = crossing(x, y, a + offset, c, d);
    if (!plane) return std::nullopt;
    return fractionOf(restPosition(slot) + u_m[slot], restPosition(far) + u_m[far], *plane);
  };
  std::vector<uint32_t> lost;  // nodes of lattices: this pass reads them as before it
  for (uint32_t slot : active) {
    if (!spared.empty() && spared[nodes[slot].hi >> layout::kBodyShift]) continue;
    for (uint32_t s = 0; s < springsOf(slot); ++s) {
      if (!isFirstEnd(slot, s) || !isWhole(slot, s)) continue;
      const uint32_t far = farEnd(slot, s);
      const bool linked = body(slot).connections != layout::kImplicit;
      const Vector3d shift =
          first_ ? Vector3d::Zero() : Vector3d(0.5 * last_dt_s_ * (v_m_per_s[slot] + v_m_per_s[far]));
      const std::optional<double> fraction = severed(slot, far, linked, shift);
      if (!fraction) continue;
      eraseSpring(slot, s, *fraction);
      ++springs_cut;
      if (!linked && !particles) lost.insert(lost.end(), {slot, far});
    }
  }
  for (const uint32_t slot : lost) remember(slot);
}

void ReferenceSolver::readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u,
                                std::vector<Vector3f>& v) const {
  for (size_t i = 0; i < slots.size(); ++i) {
    u[i] = u_m[slots[i]].cast<float>();
    v[i] = v_m_per_s[slots[i]].cast<float>();
  }
}

void ReferenceSolver::pushNodes(uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
                                const std::vector<Vector3f>& dv_m_per_s) {
  for (size_t i = 0; i < slots.size(); ++i) {
    const uint32_t slot = slots[i];
    if (isFixed(nodes[slot])) continue;
    const Vector3d dv = dv_m_per_s[i].cast<double>();
    v_m_per_s[slot] += dv;
    u_m[slot] += static_cast<double>(dt_s) * dv;
    if (stylus < layout::kMaxStyluses) impulse_n_s[stylus] += mass(slot) * dv;
  }
}

/// Cuts with the tissue at its rest position.
void ReferenceSolver::cutAtRest(const layout::ToolMotion& sweep, bool particles) {
  Field u(u_m.size(), Vector3d::Zero()), v = u;
  u_m.swap(u);
  v_m_per_s.swap(v);
  std::vector<uint8_t> others(bodies(), 1);
  others[selected_body_] = 0;
  cutWith(sweep, particles, others);
  u_m.swap(u);
  v_m_per_s.swap(v);
}

}  // namespace viscera
