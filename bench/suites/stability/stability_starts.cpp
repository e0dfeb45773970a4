// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/stability/stability_starts.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace viscera::bench {

namespace {

constexpr uint32_t kSeed = 11;
constexpr double kWide = 10;  // factor of size and of the speed of waves

/// Positions and velocities of a body's nodes, from which a state is made.
class Pose {
 public:
  explicit Pose(const Model& model) : model_(model), lattice_(model.bodies[0].lattice) {
    Eigen::AlignedBox3d box;
    for (uint32_t slot : lattice_.active_slots) box.extend(lattice_.restPosition(slot));
    low_ = box.min();
    size_ = box.sizes();
    middle_ = box.center();
  }
  /// Creates a start. @param place  rest position -> position [m]
  template <class Position>
  Start at(const std::string& name, Position position) const {
    Start start{name, restState(model_)};
    for (uint32_t slot : lattice_.active_slots) {
      const Vector3d rest = lattice_.restPosition(slot);
      start.state.displacement_m[slot] = vec4(position(rest) - rest);
    }
    return start;
  }
  const Lattice& lattice() const { return lattice_; }
  const Vector3d& low() const { return low_; }
  const Vector3d& size() const { return size_; }
  const Vector3d& middle() const { return middle_; }

 private:
  const Model& model_;
  const Lattice& lattice_;
  Vector3d low_, size_, middle_;
};

Start fast(const Model& model, const Pose& pose, std::mt19937& random) {
  Start start{"random velocities", restState(model)};
  const double speed = kWide * waveSpeed(model);
  std::uniform_real_distribution<double> uniform(-speed, speed);
  for (uint32_t slot : pose.lattice().active_slots) {
    start.state.velocity_m_per_s[slot] = vec4({uniform(random), uniform(random), uniform(random)});
  }
  return start;
}

Start swapped(const Model& model, const Pose& pose, std::mt19937& random) {
  Start start{"swapped nodes", restState(model)};
  const std::vector<uint32_t>& slots = pose.lattice().active_slots;
  std::vector<uint32_t> positions = slots;
  std::shuffle(positions.begin(), positions.end(), random);
  for (size_t i = 0; i < slots.size(); ++i) {
    const Vector3d away = pose.lattice().restPosition(positions[i]) - pose.lattice().restPosition(slots[i]);
    start.state.displacement_m[slots[i]] = vec4(away);
  }
  return start;
}

}  // namespace

std::vector<Start> extremeStarts(const Model& model) {
  const Pose pose(model);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> unit(0, 1);
  const Vector3d middle = pose.middle();
  std::vector<Start> out;
  out.push_back(pose.at("random", [&](const Vector3d&) {
    return Vector3d(pose.low() + Vector3d(unit(random), unit(random), unit(random)).cwiseProduct(pose.size()));
  }));
  out.push_back(pose.at(kCollapsed, [&](const Vector3d&) { return middle; }));
  out.push_back(pose.at("flattened", [&](const Vector3d& x) { return Vector3d(x.x(), x.y(), middle.z()); }));
  out.push_back(pose.at("mirrored", [&](const Vector3d& x) { return Vector3d(2 * middle.x() - x.x(), x.y(), x.z()); }));
  out.push_back(pose.at("10x in one axis", [&](const Vector3d& x) {
    return Vector3d(middle.x() + kWide * (x.x() - middle.x()), x.y(), x.z());
  }));
  out.push_back(pose.at("10x in all", [&](const Vector3d& x) { return Vector3d(middle + kWide * (x - middle)); }));
  out.push_back(fast(model, pose, random));
  out.push_back(swapped(model, pose, random));
  return out;
}

double energyOf(ReferenceSolver& reference, const HostState& state, double lag_s) {
  for (uint32_t slot : reference.active) {
    reference.u_m[slot] = xyz(state.displacement_m[slot]);
    reference.v_m_per_s[slot] = xyz(state.velocity_m_per_s[slot]);
    reference.nodes[slot] = state.nodes[slot];
  }
  if (lag_s > 0) {  // advances to the velocities at the time of the displacements
    Field v = reference.v_m_per_s;
    for (uint32_t slot : reference.active) {
      if (isFixed(reference.nodes[slot])) continue;
      v[slot] += lag_s * (reference.force(slot) / reference.mass(slot) - reference.mass_damping_per_s(slot) * v[slot]);
    }
    reference.v_m_per_s = v;
  }
  return reference.kineticEnergy() + reference.elasticEnergy();
}

}  // namespace viscera::bench
