// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/reference/reference_solver.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// The reference tick by tick, as Ticks goes through a scene, but always in calm substeps and without a
/// governor. vbd and pd are implicit Euler here, solved to the end.
class ReferenceTicks {
 public:
  /// @param model  must outlive this
  /// @throws SceneError  substeps (planSubsteps), parts (strengths)
  ReferenceTicks(const Model& model, const Scene& scene);

  /// @throws ConvergenceError  implicit Euler found no solution
  void step(const ToolMotions& motions);

  const ReferenceSolver& solver() const { return solver_; }
  double dt_s() const { return 1 / (tick_hz_ * substeps_); }
  double dtSafe_s() const { return dt_safe_s_; }
  int substeps() const { return substeps_; }  ///< per tick
  Vector3d impulse(uint32_t stylus) const;    ///< given to the nodes in the last tick [N s]
  double maxStretch() const;                  ///< largest |L - l0| / l0 of the current state
  double maxSpeed_m_per_s() const;            ///< of any node in the current state
  uint64_t nonfinite() const;                 ///< nodes whose u or v is not finite

 private:
  ToolActs acts_;
  double tick_hz_, dt_safe_s_;
  int substeps_;
  ReferenceSolver solver_;
  std::vector<layout::ToolMotion> motions_;
};

}  // namespace viscera
