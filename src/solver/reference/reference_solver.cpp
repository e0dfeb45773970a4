// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/reference/reference_solver.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

Vector3d xyz(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

bool isIsolated(const layout::NodeBits& bits) {
  return (bits.lo & layout::kAxialMask) == 0 && (bits.hi & layout::kDiagonalMask) == 0;
}

uint32_t heldBy(const layout::NodeBits& bits) {
  return (bits.lo & layout::kGrabMask) >> layout::kGrabShift;
}

Vector3d nearestOnSegment(const Vector3d& a, const Vector3d& b, const Vector3d& x) {
  const Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0 ? Vector3d(a + std::clamp((x - a).dot(ab) / length2, 0.0, 1.0) * ab) : a;
}

/// Does the segment a..b cross the triangle p q r? Borders belong to it.
bool crosses(const Vector3d& a, const Vector3d& b, const Vector3d& p, const Vector3d& q, const Vector3d& r) {
  const Vector3d normal = (q - p).cross(r - p);
  if (normal.isZero(0)) return false;
  const double da = (a - p).dot(normal), db = (b - p).dot(normal);
  if ((da >= 0) == (db >= 0)) return false;
  const Vector3d x = a + da / (da - db) * (b - a);
  return (q - p).cross(x - p).dot(normal) >= 0 && (r - q).cross(x - q).dot(normal) >= 0 &&
         (p - r).cross(x - r).dot(normal) >= 0;
}

double distanceToTriangle(const Vector3d& x, const Vector3d& p, const Vector3d& q, const Vector3d& r) {
  double d = std::min({(x - nearestOnSegment(p, q, x)).norm(), (x - nearestOnSegment(q, r, x)).norm(),
                       (x - nearestOnSegment(r, p, x)).norm()});
  const Vector3d normal = (q - p).cross(r - p);
  const bool inside = !normal.isZero(0) && (q - p).cross(x - p).dot(normal) >= 0 &&
                      (r - q).cross(x - q).dot(normal) >= 0 && (p - r).cross(x - r).dot(normal) >= 0;
  return inside ? std::min(d, std::abs((x - p).dot(normal)) / normal.norm()) : d;
}

/// Swept sphere of VR05 2.7.1: out of the final sphere along the radius, out of the swept capsule sideways.
void probe(const layout::ToolMotion& m, double dt_s, const Vector3d& x, Vector3d& x_next, Vector3d& v_next) {
  const double radius = m.from.w;
  const Vector3d from = xyz(m.from), to = xyz(m.to), travel = to - from;
  const Vector3d centre = (x_next - to).norm() < radius ? to : nearestOnSegment(from, to, x_next);
  const Vector3d out = x_next - centre;
  if (out.norm() >= radius) return;
  const Vector3d fallback = (x - centre).norm() > 0 ? Vector3d(x - centre)
                            : travel.norm() > 0     ? Vector3d(-travel)
                                                    : Vector3d::UnitZ();
  const Vector3d normal = (out.norm() > 1e-6 * radius ? out : fallback).normalized();
  x_next = centre + radius * normal;
  v_next -= std::min(0.0, (v_next - travel / dt_s).dot(normal)) * normal;
}

}  // namespace

ReferenceSolver::ReferenceSolver(const Model& model, const Vector3d& gravity_m_per_s2, double dt_s)
    : u_m(model.slots(), Vector3d::Zero()),
      v_m_per_s(model.slots(), Vector3d::Zero()),
      gravity_(gravity_m_per_s2),
      dt_s_(dt_s),
      neighbors_(model.slots() * layout::kSpringsPerNode),
      rest_m_(model.slots(), Vector3d::Zero()),
      grab_offsets_(model.slots(), Vector3d::Zero()) {
  impulse_n_s.fill(Vector3d::Zero());
  const double dt_safe_s = safeTimeStep(model);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Lattice& lattice = model.bodies[b].lattice;
    const uint32_t first = model.slotOffset(b);
    params_.push_back(bodyParams(model.bodies[b], dt_safe_s));
    for (layout::NodeBits bits : lattice.nodes) {
      bits.hi |= static_cast<uint32_t>(b) << layout::kBodyShift;
      nodes.push_back(bits);
    }
    for (uint32_t slot : lattice.active_slots) {
      active.push_back(first + slot);
      rest_m_[first + slot] = lattice.restPosition(slot);
      for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
        const auto& o = kNeighborOffsets[s];
        const Vector3d offset = lattice.spacing_m * Vector3d(o[0], o[1], o[2]);
        const int64_t other = lattice.neighborSlot(slot, s);
        neighbors_[(first + slot) * layout::kSpringsPerNode + s] = {
            other < 0 ? 0u : first + static_cast<uint32_t>(other), offset, offset.norm()};
      }
    }
  }
}

double ReferenceSolver::stiffness(uint32_t slot, uint32_t spring) const {
  const double unit = isAxial(spring) ? body(slot).axial_quarter_n_per_m : body(slot).diagonal_half_n_per_m;
  return springCount(nodes[slot], spring) * unit;
}

double ReferenceSolver::mass(uint32_t slot) const {
  return massEighths(nodes[slot]) * static_cast<double>(body(slot).mass_eighth_kg);
}

Vector3d ReferenceSolver::restPosition(uint32_t slot) const {
  return rest_m_[slot];
}

Vector3d ReferenceSolver::force(uint32_t slot) const {
  Vector3d sum = Vector3d::Zero();
  for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
    const double k = stiffness(slot, s);
    if (k == 0) continue;
    const Neighbor& n = neighbor(slot, s);
    const Vector3d edge = n.offset_m + u_m[n.slot] - u_m[slot];
    const double length = edge.norm();
    const Vector3d direction = length > 1e-6 * n.rest_m ? Vector3d(edge / length) : Vector3d(n.offset_m / n.rest_m);
    sum += k * (length - n.rest_m) * direction;
    sum += k * body(slot).dashpot_s * direction.dot(v_m_per_s[n.slot] - v_m_per_s[slot]) * direction;
  }
  return sum;
}

double ReferenceSolver::energy() const {
  double sum = 0;
  for (uint32_t slot : active) {
    sum += 0.5 * mass(slot) * v_m_per_s[slot].squaredNorm() - mass(slot) * gravity_.dot(u_m[slot]);
    for (uint32_t s = 0; s < layout::kSpringsPerNode; s += 2) {
      const double k = stiffness(slot, s);
      if (k == 0) continue;
      const Neighbor& n = neighbor(slot, s);
      const double extension = (n.offset_m + u_m[n.slot] - u_m[slot]).norm() - n.rest_m;
      sum += 0.5 * k * extension * extension;
    }
  }
  return sum;
}

void ReferenceSolver::substep(const std::array<layout::ToolMotion, layout::kMaxStyluses>& motions) {
  for (const layout::ToolMotion& motion : motions) {
    if (motion.info.x == layout::kModeCut || motion.info.x == layout::kModeCutParticles) cut(motion);
  }
  std::vector<Vector3d> u_next = u_m, v_next = v_m_per_s;
  const double kick_s = first_ ? 0.5 * dt_s_ : dt_s_;
  for (uint32_t slot : active) {
    if (isFixed(nodes[slot]) || (isIsolated(nodes[slot]) && heldBy(nodes[slot]) == 0)) {
      v_next[slot].setZero();
      continue;
    }
    const Vector3d acceleration = force(slot) / mass(slot) + gravity_;
    const double g = body(slot).drag_per_s * kick_s;
    v_next[slot] = ((1 - g / 2) * v_m_per_s[slot] + kick_s * acceleration) / (1 + g / 2);
    u_next[slot] = u_m[slot] + dt_s_ * v_next[slot];
    applyTools(motions, slot, u_next[slot], v_next[slot]);
  }
  u_m.swap(u_next);
  v_m_per_s.swap(v_next);
  first_ = false;
}

void ReferenceSolver::applyTools(const std::array<layout::ToolMotion, layout::kMaxStyluses>& motions, uint32_t slot,
                                 Vector3d& u_next, Vector3d& v_next) {
  const uint32_t held_by = heldBy(nodes[slot]);
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
    const layout::ToolMotion& m = motions[s];
    const Vector3d v_before = v_next;
    if (held_by == s + 1) {
      const Quaterniond q(m.orientation.w, m.orientation.x, m.orientation.y, m.orientation.z);
      u_next = xyz(m.to) + q * grab_offsets_[slot] - rest_m_[slot];
      v_next = (u_next - u_m[slot]) / dt_s_;
    } else if (held_by == 0 && m.info.x == layout::kModeProbe) {
      Vector3d x_next = rest_m_[slot] + u_next;
      probe(m, dt_s_, rest_m_[slot] + u_m[slot], x_next, v_next);
      u_next = x_next - rest_m_[slot];
    }
    impulse_n_s[s] += mass(slot) * (v_next - v_before);
  }
}

void ReferenceSolver::takeHold(uint32_t stylus, const Pose& pose, double radius_m) {
  for (uint32_t slot : active) {
    layout::NodeBits& bits = nodes[slot];
    if (isFixed(bits) || heldBy(bits) != 0 || isIsolated(bits)) continue;
    const Vector3d offset = rest_m_[slot] + u_m[slot] - pose.position_m;
    if (offset.norm() > radius_m) continue;
    grab_offsets_[slot] = pose.orientation.conjugate() * offset;
    bits.lo |= (stylus + 1) << layout::kGrabShift;
  }
}

void ReferenceSolver::letGo(uint32_t stylus, double release_speed_m_per_s) {
  for (uint32_t slot : active) {
    if (heldBy(nodes[slot]) != stylus + 1) continue;
    nodes[slot].lo &= ~layout::kGrabMask;
    const double speed = v_m_per_s[slot].norm();
    if (speed > release_speed_m_per_s) v_m_per_s[slot] *= release_speed_m_per_s / speed;
  }
}

void ReferenceSolver::cut(const layout::ToolMotion& m) {
  const Vector3d a = xyz(m.from), b = xyz(m.blade_from), c = xyz(m.blade_to), d = xyz(m.to);
  const auto position = [&](uint32_t slot) { return Vector3d(rest_m_[slot] + u_m[slot]); };
  const auto erased = [&](const Vector3d& x) {
    return std::min(distanceToTriangle(x, a, b, c), distanceToTriangle(x, a, c, d)) <= m.blade_from.w;
  };
  for (uint32_t slot : active) {
    for (uint32_t s = 0; s < layout::kSpringsPerNode; s += 2) {  // each spring once, from its lower end
      if (springCount(nodes[slot], s) == 0) continue;
      const uint32_t other = neighbor(slot, s).slot;
      const Vector3d x = position(slot), y = position(other);
      const bool severed = m.info.x == layout::kModeCutParticles ? erased(x) || erased(y)
                                                                 : crosses(x, y, a, b, c) || crosses(x, y, a, c, d);
      if (!severed) continue;
      setSpringCount(nodes[slot], s, 0);
      setSpringCount(nodes[other], oppositeSpring(s), 0);
      nodes[slot].lo |= layout::kSeveredBit;
      nodes[other].lo |= layout::kSeveredBit;
      ++springs_cut;
    }
  }
}

}  // namespace viscera
