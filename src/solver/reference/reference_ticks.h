// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/contact/environment.h"
#include "solver/contact/tool_acts.h"
#include "solver/reference/reference_solver.h"
#include "solver/ticks/process_list.h"
#include "viscera/tools/stylus.h"

namespace viscera {

struct Scene;

/// The reference tick by tick, as TissueStepper runs a scene, with the same processes in the tissue, but always in calm
/// substeps and without a stability monitor (stability monitor). Here pd is implicit Euler, solved to convergence.
class ReferenceTicks {
 public:
  /// @param model  must outlive this
  /// @throws SceneError  substeps (planSubsteps), parts (strengths), tissue that tears
  ReferenceTicks(const Model& model, const Scene& scene);

  /// Advances by a tick.
  /// @throws ConvergenceError  implicit Euler found no solution
  /// @param obstacles  motions over the tick, of all obstacles of the scene; empty: they stay where they were last
  void step(const ToolMotions& motions, const ObstacleMotions& obstacles = {});

  /// Sets the state, all of one time: time integration restarts with half a kick. @param u_m, v_m_per_s  [slots]
  void load(const std::vector<layout::vec4>& u_m, const std::vector<layout::vec4>& v_m_per_s);
  const ReferenceSolver& solver() const { return solver_; }
  double dt_s() const { return 1 / (tick_hz_ * substeps_); }
  double dtSafe_s() const { return dt_safe_s_; }
  int substeps() const { return substeps_; }  ///< number per tick
  Vector3d impulse(uint32_t stylus) const;    ///< momentum given to the nodes in the last tick [N s]
  Vector3d obstacleImpulse(size_t obstacle) const {
    return solver_.obstacle_impulse_n_s[obstacle] - obstacle_before_n_s_[obstacle];
  }
  /// Returns the processes in the tissue. Their state is float64 too, but TissuePort rounds what they read and give to
  /// float32.
  const TissueProcesses& processes() const { return processes_.all(); }
  double maxStretch() const;        ///< largest |L - l0| / l0 of the current state
  double maxSpeed_m_per_s() const;  ///< largest speed of a node in the current state
  uint64_t nonfinite() const;       ///< number of nodes with u or v not finite

 private:
  ToolActs acts_;
  double tick_hz_, dt_safe_s_;
  int substeps_;
  Environment environment_;  ///< motions of obstacles and time; the solver applies them
  ReferenceSolver solver_;
  ProcessList processes_;
  uint64_t cuts_seen_ = 0;                                           ///< springs cut when processes were last notified
  bool first_ = true;                                                ///< no tick was made yet
  std::array<Vector3d, layout::kMaxObstacles> obstacle_before_n_s_;  ///< momentum given when the tick began
  std::vector<layout::ToolMotion> motions_;
};

}  // namespace viscera
