// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/node_contacts.h"

#include "solver/contact/node_pairs.h"
#include "solver/reference/reference_environment.h"

namespace viscera {

NodeContacts::NodeContacts(const ReferenceSolver& solver, const Field& predicted_m) : solver_(solver) {
  const ReferenceEnvironment* environment = solver.environment();
  if (!environment || !environment->collides()) return;
  friction_ = environment->collision().friction;
  restitution_ = environment->collision().restitution;
  constexpr double kReach = static_cast<double>(kPairReach);
  const auto touching = environment->touching(solver, predicted_m, kReach);
  const ContactNormals normals(solver, touching, solver.u_m, predicted_m);
  for (const auto& pair : touching) {
    const double apart_m =
        (solver.restPosition(pair.a) + solver.u_m[pair.a] - solver.restPosition(pair.b) - solver.u_m[pair.b]).norm();
    pairs_.push_back({pair.a, pair.b, normals.of(pair), std::max(0.0, apart_m - pair.distance_m / kReach), 0});
  }
}

void NodeContacts::tell(Increment& increment, double scale_n_per_m) const {
  constexpr double kStiffer = 100;  // each guess leaves a hundredth of the previous violation
  increment.setPairs(pairs_, kStiffer * scale_n_per_m);
}

void NodeContacts::addDrags(std::vector<Increment::Drag>& drags) const {
  for (const Increment::Pair& p : pairs_) {
    const double limit_n = friction_ * p.pressure_n;
    if (limit_n <= 0) continue;
    drags.push_back({p.a, p.normal, solver_.u_m[p.a], limit_n, p.b, solver_.u_m[p.b]});
  }
}

bool NodeContacts::mend(const Increment& increment, const Field& u_m, double tolerance_n) {
  bool changed = false;
  for (Increment::Pair& p : pairs_) {
    const double pressure_n = increment.pressure(p, u_m);
    changed |= std::abs(pressure_n - p.pressure_n) > tolerance_n;
    p.pressure_n = pressure_n;
  }
  return changed;
}

void NodeContacts::bounce(const std::vector<bool>& free, Field& v_next) const {
  std::vector<int> pressing(solver_.slots(), 0);
  for (const Increment::Pair& p : pairs_) {
    if (p.pressure_n <= 0) continue;
    ++pressing[p.a];
    ++pressing[p.b];
  }
  const auto mobility = [&](uint32_t slot) { return free[slot] ? pressing[slot] / solver_.mass(slot) : 0; };
  const Field v = v_next;
  for (const Increment::Pair& p : pairs_) {
    const double came = (solver_.v_m_per_s[p.b] - solver_.v_m_per_s[p.a]).dot(p.normal);
    const double give = mobility(p.a) + mobility(p.b);
    if (p.pressure_n <= 0 || came <= solver_.restingSpeed() || give == 0) continue;
    const double leaves = (v[p.a] - v[p.b]).dot(p.normal);
    const Vector3d impulse = std::max(0.0, restitution_ * came - leaves) / give * p.normal;
    if (free[p.a]) v_next[p.a] += impulse / solver_.mass(p.a);
    if (free[p.b]) v_next[p.b] -= impulse / solver_.mass(p.b);
  }
}

}  // namespace viscera
