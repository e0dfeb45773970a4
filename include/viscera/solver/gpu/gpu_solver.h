// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "viscera/gpu/readback.h"
#include "viscera/solver/gpu/cut_pass.h"
#include "viscera/solver/gpu/good_states.h"
#include "viscera/solver/gpu/grab_pass.h"
#include "viscera/solver/gpu/lattice_buffers.h"
#include "viscera/solver/gpu/measure_pass.h"
#include "viscera/solver/gpu/reaction_pass.h"
#include "viscera/solver/gpu/stepper.h"
#include "viscera/solver/solver.h"
#include "viscera/solver/substeps.h"

namespace viscera {

struct GpuSolverOptions {
  uint32_t group_size = layout::kGroupSize;
  bool allow_unstable = false;  ///< take a substep that is too long for the integrator: to study the governor
};

/// The solver whose state lives on the GPU (OpenGL compute).
class GpuSolver : public Solver {
 public:
  /// @param model  must outlive the solver
  /// @throws GpuError  shaders, memory;  SceneError  substeps (planSubsteps), parts (strengths)
  GpuSolver(const Model& model, const Scene& scene, const GpuSolverOptions& options = {});

  void step(const ToolMotions& motions) override;
  void reset() override;
  StateView state() const override;
  HostState readState() const override;
  bool pollStats(layout::TickStats& stats, bool wait) override;
  const Health& health() const override;
  double dt_s() const override { return tick_s_ / plan_.calm; }
  double dtSafe_s() const override { return dt_safe_s_; }
  int substeps() const override { return plan_.calm; }
  uint64_t substepsDone() const override { return substeps_done_; }
  std::string backend() const override { return "gpu"; }

  /// How long before the displacements the velocities belong [s]: half a substep after leapfrog, else 0.
  double velocityLag_s() const;

  /// Sets the state, for tests and saved sessions.
  /// @param staggered  the velocities are those of half a substep earlier, as readState() gives them for leapfrog;
  ///                   otherwise they belong to the same moment as the displacements and time starts anew with a half
  ///                   kick
  void writeState(const HostState& state, bool staggered = false);

 private:
  struct Tools {  ///< what only a scene with styluses needs
    gpu::Buffer<layout::ToolMotion> motions;
    GrabPass grab;
    CutPass cut;
    ReactionPass reaction;
  };
  struct Watch {  ///< what only a scene with a governor needs
    Governor governor;
    GoodStates good;
    std::unique_ptr<Stepper> recovery;  ///< pd without acceleration: every sweep descends
    int recovery_substeps;
    layout::TickStats last_good;
  };
  void chooseStepper();
  void changeGrips(const ToolMotions& motions);
  void substep(size_t index, const ToolMotions& motions, bool contacts);
  void cut(const ToolMotions& motions);
  void queueStats();
  bool takeStats(layout::TickStats& stats, bool wait);
  void govern(const ToolMotions& motions);
  void relaxSubsteps(const layout::TickStats& stats);

  const Model& model_;
  SolverConfig config_;
  std::vector<StylusConfig> styluses_;
  Vector3f gravity_;
  double tick_s_, dt_safe_s_, push_speed_m_per_s_;
  SubstepPlan plan_;
  FeatureSet features_;
  LatticeBuffers buffers_;
  std::unique_ptr<Stepper> stepper_;
  MeasurePass measure_;
  std::optional<Tools> tools_;
  std::optional<Watch> watch_;
  gpu::ReadbackRing stats_ring_;
  std::vector<layout::TickStats> finished_;  ///< came back while nobody asked
  std::vector<layout::ToolMotion> motions_;
  uint64_t tick_ = 0, cut_revision_ = 0, substeps_done_ = 0;
  uint32_t springs_cut_ = 0;   ///< when dt_safe was last computed
  Stepper* active_ = nullptr;  ///< of this tick
  int n_ = 1;                  ///< substeps of this tick
  bool restarted_ = true;      ///< the next substep starts anew
  double last_dt_s_ = 0;
};

}  // namespace viscera
