// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/wound_lips.h"

#include <algorithm>

namespace viscera {

namespace {

constexpr int kLipSweeps = 2;               // over the pairs: nodes are in several
constexpr double kLipsApart = 0.2;          // share of the overlap that is removed per substep
constexpr double kLipsMost_m_per_s = 0.02;  // speed of separation: slow, as this speed remains
constexpr double kLipsMeet = 1e-3;          // of the distance at rest: nearer nodes have no direction

bool holdsNothing(const layout::NodeBits& bits) {
  return (bits.lo & layout::kAxialMask) == 0 && (bits.hi & layout::kDiagonalMask) == 0;
}

}  // namespace

void WoundLips::find(const Model& model, const CutSprings& cuts) {
  pairs_.clear();
  size_t first_spring = 0;
  for (uint32_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.network) {
      addNetwork(model, b, first_spring, cuts);
      first_spring += body.network->springs.size();
    } else {
      addLattice(model, b, cuts);
    }
  }
}

void WoundLips::add(const Model& model, uint32_t body, uint32_t a, uint32_t b) {
  if (pairs_.size() == kMostPairs) return;
  Pair pair{nodePoint(model, body, a), nodePoint(model, body, b), 0};
  pair.apart_m = (pair.a.rest_m - pair.b.rest_m).norm();
  if (pair.apart_m > 0) pairs_.push_back(pair);
}

/// Adds pairs by axial springs across a cut. What an eraser has left of a node touches nothing.
void WoundLips::addLattice(const Model& model, uint32_t body, const CutSprings& cuts) {
  if (cuts.nodes.empty()) return;
  const Lattice& lattice = model.bodies[body].lattice;
  const uint32_t offset = model.slotOffset(body);
  for (const uint32_t slot : lattice.active_slots) {
    const layout::NodeBits& now = cuts.nodes[offset + slot];
    if (!(now.lo & layout::kSeveredBit) && now.lo == lattice.nodes[slot].lo) continue;
    for (uint32_t s = 0; s < layout::kAxialSprings; s += 2) {
      const int64_t other = lattice.neighborSlot(slot, s);
      if (other < 0 || springCount(lattice.nodes[slot], s) == 0 || springCount(now, s) > 0) continue;
      const auto end = static_cast<uint32_t>(other);
      if (!holdsNothing(now) && !holdsNothing(cuts.nodes[offset + end])) add(model, body, slot, end);
    }
  }
}

void WoundLips::addNetwork(const Model& model, uint32_t body, size_t first_spring, const CutSprings& cuts) {
  if (cuts.spring_cut.empty()) return;
  const std::vector<NetworkSpring>& springs = model.bodies[body].network->springs;
  for (size_t s = 0; s < springs.size(); ++s) {
    const NetworkSpring& spring = springs[s];
    const float cut = cuts.spring_cut[first_spring + s];
    const bool diagonal = spring.lattice_spring != layout::kNoLatticeSpring && !isAxial(spring.lattice_spring);
    if (cut > 0 && cut < 1 && !diagonal && !spring.against_bending) add(model, body, spring.a, spring.b);
  }
}

void WoundLips::addPoints(std::vector<const TissuePoint*>& points) const {
  for (const Pair& pair : pairs_) points.insert(points.end(), {&pair.a, &pair.b});
}

void WoundLips::part(TissuePoints& points, double dt_s) const {
  for (int sweep = 0; sweep < kLipSweeps; ++sweep) {
    for (const Pair& pair : pairs_) {
      const Vector3d between = points.position_m(pair.b) - points.position_m(pair.a);
      const double length_m = between.norm(), near_m = pair.apart_m - length_m;
      if (!(near_m > 0) || length_m < kLipsMeet * pair.apart_m) continue;
      const Vector3d out = between / length_m;
      const double away_m_per_s = (points.velocity_m_per_s(pair.b) - points.velocity_m_per_s(pair.a)).dot(out);
      const double mobility = points.mobility(pair.a, pair.a) + points.mobility(pair.b, pair.b);
      const double missing_m_per_s = std::min(kLipsApart * near_m / dt_s, kLipsMost_m_per_s) - away_m_per_s;
      if (!(missing_m_per_s > 0) || !(mobility > 0)) continue;
      const Vector3d impulse = missing_m_per_s / mobility * out;
      points.give(pair.a, -impulse, dt_s);
      points.give(pair.b, impulse, dt_s);
    }
  }
}

}  // namespace viscera
