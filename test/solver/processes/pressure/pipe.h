// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "math/number_text.h"
#include "solver/processes/pressure/pressures.h"
#include "support/solver_rig.h"
#include "viscera/model/scene/scene.h"

namespace viscera::test {

/// Pipe along the x axis, for tests of pressure.
constexpr double kOuter_m = 0.003, kWall_m = 0.0008, kInner_m = kOuter_m - kWall_m;
inline const char* const kStill =
    "environment: {gravity_m_per_s2: [0, 0, 0]}\nsolver: {backend: cpu, threads: 1, sleep_speed_m_per_s: 0}\n";
// Density is high, so that substeps are few; at rest it has no effect.
inline const char* const kHeldEnds =
    "fixed: [{shape: plane, point_m: [-0.012, 0, 0], normal: [1, 0, 0]}, "
    "{shape: plane, point_m: [0.012, 0, 0], normal: [-1, 0, 0]}]";

inline Scene pipe(const std::string& material, double pressure_pa, const std::string& more) {
  return parseScene("bodies:\n  - {name: pipe, source: tube, spacing_m: 0.001, tube: {radius_m: " +
                        exactText(kOuter_m) + ", wall_m: " + exactText(kWall_m) +
                        ", path: [{position_m: [-0.012, 0, 0]}, {position_m: [0.012, 0, 0]}]}, pressure: {mean_pa: " +
                        exactText(pressure_pa) + "}, material: {" + material + "}, " + more + "}\n" + kStill,
                    "pipe.yaml");
}

inline const Pressures& pressuresOf(const Solver& solver) {
  return *findProcess<Pressures>(solver);
}

/// Returns a fact of the first body.
inline double pressureFact(const Pressures& pressures, const std::string& name) {
  const FactGroups groups = {pressures.facts()};
  for (const Fact& fact : std::get<std::vector<Fact::Facts>>(*findFact(groups, "pressures", "on")).at(0))
    if (fact.name == name) return std::get<double>(fact.value);
  return -1;
}
inline double pressureFact(const Solver& solver, const std::string& name) {
  return pressureFact(pressuresOf(solver), name);
}

/// Returns the motion of a tool that points down, its width along the y axis.
inline StylusMotion downAt(ToolMode mode, const Vector3d& from_m, const Vector3d& to_m) {
  StylusMotion out = motionOf(mode, from_m, to_m);
  out.from.orientation = out.to.orientation = rotationFromDegrees({0, 0, 90});
  return out;
}

/// Cuts with a blade from its tip upwards, across a pipe along x.
inline void cutAcross(Solver& solver, double x_m) {
  constexpr int kDraws = 8;
  const auto at = [&](int i) { return Vector3d(x_m, 0.006 - 0.012 * i / kDraws, -0.006); };
  for (int i = 0; i < kDraws; ++i) solver.step(ToolMotions{downAt(ToolMode::kCut, at(i), at(i + 1))});
}

}  // namespace viscera::test
