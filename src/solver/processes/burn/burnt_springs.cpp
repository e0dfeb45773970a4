// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/burn/burnt_springs.h"

#include <algorithm>
#include <cmath>

#include "model/body/body_nodes.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

namespace {

constexpr double kLeastCoagulated = 0.01;  // smallest coagulated share of a spring that is handled
constexpr int kMostSweeps = 12;         // of conjugate gradients: leave less than kLeftOfSpring in threefold stiffness
constexpr double kLeftOfSpring = 1e-4;  // tolerance over the impulses, root mean square
constexpr double kCollapsed = 1e-6;     // of a length: a shorter spring has no direction

}  // namespace

BurntSprings::BurntSprings(const Model& model)
    : rest_m_(model.slots(), Vector3f::Zero()), inverse_mass_(model.slots(), 0), position_(model.slots(), 0) {
  for (uint32_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const uint32_t offset = model.slotOffset(b);
    const std::vector<float> masses = body.network ? std::vector<float>() : strengths(body).mass_kg;
    forEachNode(body, [&](uint32_t slot) {
      const double kg = body.network ? body.network->masses_kg[slot] : static_cast<double>(masses[slot]);
      rest_m_[offset + slot] = restPosition(body, slot).cast<float>();
      if (!isFixed(body.lattice.nodes[slot])) inverse_mass_[offset + slot] = 1 / kg;
    });
  }
}

/// Finds the coagulated springs. A spring coagulated by a share c should have k (1 + (kStiffened - 1) c) and be kShrunk
/// c shorter at rest. Its own k and length are kept. The difference is a stiffness, and a tension, which also
/// compensates the resistance of the surrounding cells' volumes to shrinkage.
void BurntSprings::find(const HeatField& heat, const CutSprings& cuts) {
  springs_.clear();
  slots_.clear();
  const HeatGraph& graph = heat.graph();
  std::vector<uint32_t> all;
  for (const uint32_t slot : heat.touched()) {
    if (heat.coagulated(slot) < kLeastCoagulated) continue;
    all.insert(all.end(), graph.springs_of.begin() + graph.spring_starts[slot],
               graph.springs_of.begin() + graph.spring_starts[slot + 1]);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  const auto positionOf = [this](uint32_t slot) {
    if (position_[slot] == 0) {
      slots_.push_back(slot);
      position_[slot] = static_cast<uint32_t>(slots_.size());
    }
    return position_[slot] - 1;
  };
  for (const uint32_t s : all) {
    const BurntSpring& spring = graph.springs[s];
    if (!cuts.nodes.empty() && spring.isCut(cuts)) continue;
    const double share = 0.5 * (heat.coagulated(spring.a) + heat.coagulated(spring.b));
    const double stiffer = 1 + (kStiffened - 1) * share;
    Spring out;
    out.a = positionOf(spring.a);
    out.b = positionOf(spring.b);
    out.rest_length_m = spring.rest_length_m;
    out.more_n_per_m = spring.stiffness_n_per_m * (stiffer - 1);
    out.tension_n = spring.stiffness_n_per_m * spring.rest_length_m * kShrunk * share * (stiffer + spring.volume_ratio);
    springs_.push_back(out);
  }
  for (const uint32_t slot : slots_) position_[slot] = 0;
}

/// Multiplies a velocity by (1 + dt^2 K / m), with K the stiffness along each spring and the effect of its tension
/// across.
void BurntSprings::multiply(double dt_s, const std::vector<Vector3d>& by, std::vector<Vector3d>& out) const {
  for (size_t i = 0; i < slots_.size(); ++i) {
    const double w = inverse_mass_[slots_[i]];
    out[i] = w > 0 ? Vector3d(by[i] / w) : Vector3d::Zero();
  }
  for (const Spring& spring : springs_) {
    const Vector3d apart = by[spring.b] - by[spring.a];
    const Vector3d force = dt_s * dt_s *
                           (spring.across_n_per_m * apart +
                            (spring.more_n_per_m - spring.across_n_per_m) * spring.along.dot(apart) * spring.along);
    out[spring.a] -= force;
    out[spring.b] += force;
  }
  for (size_t i = 0; i < slots_.size(); ++i) {
    if (inverse_mass_[slots_[i]] == 0) out[i].setZero();
  }
}

double BurntSprings::pull(TissuePort& port, double dt_s) {
  const size_t count = slots_.size();
  u_.resize(count);
  v_.resize(count);
  port.readNodes(slots_, u_, v_);
  for (std::vector<Vector3d>* all : {&dv_, &residual_, &direction_, &product_}) all->assign(count, Vector3d::Zero());
  for (Spring& spring : springs_) {
    const Vector3d from = (rest_m_[slots_[spring.a]] + u_[spring.a]).cast<double>();
    const Vector3d apart = (rest_m_[slots_[spring.b]] + u_[spring.b]).cast<double>() - from;
    const double length_m = apart.norm();
    spring.along = length_m > kCollapsed * spring.rest_length_m ? Vector3d(apart / length_m) : Vector3d::Zero();
    const double force_n = spring.more_n_per_m * (length_m - spring.rest_length_m) + spring.tension_n;
    spring.across_n_per_m = std::max(0.0, force_n) / std::max(length_m, kCollapsed * spring.rest_length_m);
    residual_[spring.a] += dt_s * force_n * spring.along;
    residual_[spring.b] -= dt_s * force_n * spring.along;
  }
  // Conjugate gradients, in the inner product of 1/m.
  const auto dot = [&](const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
    double sum = 0;
    for (size_t i = 0; i < count; ++i) sum += a[i].dot(b[i]) * inverse_mass_[slots_[i]];
    return sum;
  };
  for (size_t i = 0; i < count; ++i) {
    if (inverse_mass_[slots_[i]] == 0) residual_[i].setZero();
    direction_[i] = inverse_mass_[slots_[i]] * residual_[i];
  }
  double now = dot(residual_, residual_);
  const double enough = kLeftOfSpring * kLeftOfSpring * now;
  for (int sweep = 0; sweep < kMostSweeps && now > enough; ++sweep) {
    multiply(dt_s, direction_, product_);
    double along = 0;
    for (size_t i = 0; i < count; ++i) along += direction_[i].dot(product_[i]);
    const double step = now / along, before = now;
    for (size_t i = 0; i < count; ++i) {
      dv_[i] += step * direction_[i];
      residual_[i] -= step * product_[i];
    }
    now = dot(residual_, residual_);
    for (size_t i = 0; i < count; ++i)
      direction_[i] = inverse_mass_[slots_[i]] * residual_[i] + (now / before) * direction_[i];
  }
  double work_j = 0;
  for (size_t i = 0; i < count; ++i) {
    const double w = inverse_mass_[slots_[i]];
    if (w > 0) work_j += dv_[i].dot(v_[i].cast<double>() + 0.5 * dv_[i]) / w;
  }
  std::vector<Vector3f>& changes = v_;
  for (size_t i = 0; i < count; ++i) changes[i] = dv_[i].cast<float>();
  port.pushNodes(layout::kMaxStyluses, static_cast<float>(dt_s), slots_, changes);
  return work_j;
}

}  // namespace viscera
