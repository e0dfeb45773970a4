// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/reference_solver.h"

#include <cmath>

#include "math/vec4.h"
#include "model/scene/integrators.h"

namespace viscera {

ReferenceSolver::ReferenceSolver(const Model& model, const Vector3d& gravity_m_per_s2, double dt_s,
                                 const ReferenceOptions& options)
    : ReferenceLattice(model),
      u_m(model.slots(), Vector3d::Zero()),
      v_m_per_s(model.slots(), Vector3d::Zero()),
      gravity_(gravity_m_per_s2),
      dt_s_(dt_s),
      last_dt_s_(dt_s),
      options_(options),
      grab_offsets_(model.slots(), Vector3d::Zero()) {
  impulse_n_s.fill(Vector3d::Zero());
  obstacle_impulse_n_s.fill(Vector3d::Zero());
  markTick();
}

Vector3d ReferenceSolver::force(uint32_t slot) const {
  const bool leapfrog = options_.integrator == ReferenceIntegrator::kLeapfrog;
  return elasticForce(u_m, slot) + (leapfrog ? dampingForce(u_m, v_m_per_s, slot) : dashpotForce(u_m, v_m_per_s, slot));
}

double ReferenceSolver::kineticEnergy() const {
  double sum = 0;
  for (uint32_t slot : active) sum += 0.5 * mass(slot) * v_m_per_s[slot].squaredNorm();
  return sum;
}

double ReferenceSolver::gravityEnergy() const {
  double sum = 0;
  for (uint32_t slot : active) sum -= mass(slot) * gravityAt(slot).dot(u_m[slot]);
  return sum;
}

double ReferenceSolver::energy() const {
  return kineticEnergy() + elasticEnergy() + gravityEnergy();
}

Vector3d ReferenceSolver::momentum() const {
  Vector3d sum = Vector3d::Zero();
  for (uint32_t slot : active) sum += mass(slot) * v_m_per_s[slot];
  return sum;
}

HostState ReferenceSolver::state() const {
  HostState out;
  for (const Vector3d& u : u_m) out.displacement_m.push_back(rounded(u));
  for (const Vector3d& v : v_m_per_s) out.velocity_m_per_s.push_back(rounded(v));
  out.nodes = nodes;
  out.spring_cut = spring_cut;
  out.axial_cut.assign(axial_cut.begin(), axial_cut.end());
  return out;
}

/// Returns the acceleration by gravity; ghosts have no weight.
Vector3d ReferenceSolver::gravityAt(uint32_t slot) const {
  return isGhost(nodes[slot]) ? Vector3d::Zero() : gravity_;
}

bool ReferenceSolver::rests(uint32_t slot) const {
  if (isGhost(nodes[slot])) {
    const uint32_t spring = springOfGhost(nodes[slot]);
    return !viscera::isWithinRow(nodes[farEnd(slot, spring)], static_cast<int>(spring / 2));
  }
  return isFixed(nodes[slot]) || (isIsolated(slot) && heldBy(slot) == 0);
}

void ReferenceSolver::setSubstep(double dt_s) {
  dt_s_ = dt_s;
}

void ReferenceSolver::substep(const SubstepMotions& motions, const SubstepOutside& outside) {
  motions_ = motions;
  obstacles_.clear();
  for (const layout::ObstacleMotion& motion : outside.obstacles) obstacles_.emplace_back(motion, dt_s_);
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
    const uint32_t effects = motions[s].info.y;
    if (effects & (layout::kToolCuts | layout::kToolErases)) cut(s, (effects & layout::kToolErases) != 0);
  }
  // Wind and forces are part of an implicit substep by its initial velocities. After an explicit one they act on their
  // own, between the contacts of nodes and obstacles.
  const bool implicit = options_.integrator == ReferenceIntegrator::kImplicitEuler;
  if (implicit) blow(outside, u_m, v_m_per_s, nullptr);
  Field u_next = u_m, v_next(slots(), Vector3d::Zero());
  integrate(u_next, v_next);
  for (uint32_t slot : active) {
    if (rests(slot)) continue;
    if (!implicit && !isGhost(nodes[slot])) applyTools(motions, slot, u_next[slot], v_next[slot]);
    sleep(slot, u_next[slot], v_next[slot]);
  }
  for (uint32_t s = 0; options_.integrator == ReferenceIntegrator::kLeapfrog && s < layout::kMaxStyluses; ++s) {
    if (pushesByTip(motions[s])) applyEdges(motions[s], false, s, u_next, v_next);
    if (pushesByShaft(motions[s])) applyEdges(motions[s], true, s, u_next, v_next);
  }
  collide(u_next, v_next);
  if (!implicit) {
    blow(outside, u_next, v_next, &u_next);
    meetObstacles(u_next, v_next);
  }
  if (options_.environment || !obstacles_.empty()) {
    for (uint32_t slot : active) {
      if (!rests(slot)) sleep(slot, u_next[slot], v_next[slot]);
    }
  }
  u_m.swap(u_next);
  v_m_per_s.swap(v_next);
  first_ = false;
  last_dt_s_ = dt_s_;
}

void ReferenceSolver::integrate(Field& u_next, Field& v_next) {
  switch (options_.integrator) {
    case ReferenceIntegrator::kLeapfrog:
      return leapfrog(u_next, v_next);
    case ReferenceIntegrator::kVerletPaper:
      return verletPaper(u_next, v_next);
    case ReferenceIntegrator::kImplicitEuler:
      return implicitEuler(u_next, v_next);
  }
}

/// Velocities are half a substep earlier than displacements. A kick spans from the middle of the last substep to that
/// of this one; the first, from the same time, is half a kick.
void ReferenceSolver::leapfrog(Field& u_next, Field& v_next) const {
  const double kick_s = first_ ? 0.5 * dt_s_ : 0.5 * (last_dt_s_ + dt_s_);
  const Field elastic = elasticForces(lawPositions(u_m, v_m_per_s));
  for (uint32_t slot : active) {
    if (rests(slot)) continue;
    Vector3d force = elastic[slot];
    if (!obeysLaw(slot)) force += dampingForce(u_m, v_m_per_s, slot);
    const double g = mass_damping_per_s(slot) * kick_s;
    v_next[slot] = ((1 - g / 2) * v_m_per_s[slot] + kick_s * (force / mass(slot) + gravityAt(slot))) / (1 + g / 2);
    u_next[slot] = u_m[slot] + dt_s_ * v_next[slot];
  }
}

/// x+ = 2 x - x_prev + dt^2 (F/m + g - gamma (x - x_prev)/dt), with v = (x - x_prev)/dt in the place of x_prev, which
/// is the same in exact arithmetic. The effect of float32 on x and x_prev is tested with the kernel. As in the papers,
/// it starts with a full kick.
void ReferenceSolver::verletPaper(Field& u_next, Field& v_next) const {
  const Field elastic = elasticForces(u_m);
  for (uint32_t slot : active) {
    if (rests(slot)) continue;
    const Vector3d& v = v_m_per_s[slot];
    v_next[slot] = v + dt_s_ * (elastic[slot] / mass(slot) + gravity_ - mass_damping_per_s(slot) * v);
    u_next[slot] = u_m[slot] + dt_s_ * v_next[slot];
  }
}

void ReferenceSolver::sleep(uint32_t slot, Vector3d& u_next, Vector3d& v_next) const {
  if (heldBy(slot) != 0) return;
  if (u_next.norm() <= options_.sleep_distance_m || u_next.norm() <= u_m[slot].norm()) return;
  if ((u_next - u_m[slot]).norm() > 0.1 * options_.sleep_distance_m) return;  // not a fall, but an explosion
  u_next = u_m[slot];
  v_next.setZero();
}

}  // namespace viscera
