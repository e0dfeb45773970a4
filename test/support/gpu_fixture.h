// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "gpu/program.h"
#include "math/vec4.h"
#include "solver/gpu/gpu_solver.h"
#include "solver/reference/reference_solver.h"
#include "solver/tissue/joined_lattice.h"
#include "support/lattices.h"
#include "viscera/gpu/context.h"
#include "viscera/model/scene/scene.h"

namespace viscera::test {

/// Gives every test an EGL context. A machine without one fails the test; it does not skip it.
class GpuTest : public ::testing::Test {
 protected:
  GpuTest() { gpu::checkDispatches(true); }
  gpu::Context context_;
};

/// Returns a scene with ticks of `substeps` substeps of half the largest stable one.
inline Scene sceneFor(const Model& model, int substeps, std::vector<StylusConfig> styluses = {},
                      const Vector3d& gravity = Vector3d::Zero()) {
  Scene scene;
  scene.styluses = std::move(styluses);
  scene.environment.gravity_m_per_s2 = gravity;
  scene.solver.dt_fraction = scene.solver.dt_fraction_strained = 0.5;
  scene.solver.sleep_distance_m = 1e6;
  scene.solver.stability_monitor = false;  // kernels are tested: nothing else may act
  scene.solver.sleep_speed_m_per_s = 0;
  const double dt_safe_s = safeTimeStep(model);
  const double dt_s = std::isfinite(dt_safe_s) ? 0.5 * dt_safe_s : 1e-3;
  scene.solver.tick_hz = 1.0 / (substeps * dt_s) * (1 + 1e-9);
  return scene;
}

/// Returns motions with the first stylus as a probe at rest.
inline ToolMotions probeAt(const Vector3d& tip_m) {
  ToolMotions out;
  out[0].mode = ToolMode::kProbe;
  out[0].present = true;
  out[0].from.position_m = out[0].to.position_m = tip_m;
  return out;
}

inline layout::vec4 vec4(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
}

inline HostState restState(const Model& model) {
  HostState state;
  state.displacement_m.assign(model.slots(), layout::vec4{});
  state.velocity_m_per_s.assign(model.slots(), layout::vec4{});
  state.nodes = allNodes(model);
  for (const Body& body : model.bodies) {
    if (body.network) state.spring_cut.resize(state.spring_cut.size() + body.network->springs.size());
  }
  return state;
}

inline Vector3d randomVector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return {uniform(random), uniform(random), uniform(random)};
}

/// Loads the state of the host into the reference.
inline void load(ReferenceSolver& reference, const HostState& state) {
  for (uint32_t slot : reference.active) {
    reference.u_m[slot] = xyz(state.displacement_m[slot]);
    reference.v_m_per_s[slot] = xyz(state.velocity_m_per_s[slot]);
    reference.nodes[slot] = state.nodes[slot];
  }
  if (!state.spring_cut.empty()) reference.spring_cut = state.spring_cut;
  std::fill(reference.cut_sides.begin(), reference.cut_sides.end(), Vector3d::Zero());
}

/// Returns the largest nodal error over the largest value of the reference.
inline double relativeError(const std::vector<layout::vec4>& values, const std::vector<Vector3d>& truth,
                            const std::vector<uint32_t>& active) {
  double error = 0, size = 0;
  for (uint32_t slot : active) {
    error = std::max(error, (xyz(values[slot]) - truth[slot]).norm());
    size = std::max(size, truth[slot].norm());
  }
  return size > 0 ? error / size : error;
}

}  // namespace viscera::test
