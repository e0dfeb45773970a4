// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "viscera/gpu/readback.h"
#include "viscera/solver/gpu/cut_pass.h"
#include "viscera/solver/gpu/grab_pass.h"
#include "viscera/solver/gpu/integrate_pass.h"
#include "viscera/solver/gpu/lattice_buffers.h"
#include "viscera/solver/gpu/measure_pass.h"
#include "viscera/solver/gpu/reaction_pass.h"
#include "viscera/solver/solver.h"

namespace viscera {

/// The solver whose state lives on the GPU (OpenGL compute).
class GpuSolver : public Solver {
 public:
  /// @param model  must outlive the solver
  /// @throws GpuError  shaders, memory;  SceneError  more substeps per tick than max_substeps
  GpuSolver(const Model& model, const Scene& scene, uint32_t group_size = layout::kGroupSize);

  void step(const ToolMotions& motions) override;
  void reset() override;
  StateView state() const override;
  HostState readState() const override;
  bool pollStats(layout::TickStats& stats, bool wait) override;
  double dt_s() const override { return dt_s_; }
  double dtSafe_s() const override { return dt_safe_s_; }
  int substeps() const override { return substeps_; }
  std::string backend() const override { return "gpu"; }

  /// Sets the state, for tests and saved sessions.
  /// @param staggered  the velocities are those of half a substep earlier, as readState() gives them; otherwise they
  ///                   belong to the same moment as the displacements and time starts anew with a half kick
  void writeState(const HostState& state, bool staggered = false);

 private:
  struct Tools {  ///< what only a scene with styluses needs
    gpu::Buffer<layout::ToolMotion> motions;
    GrabPass grab;
    CutPass cut;
    ReactionPass reaction;
  };
  void changeGrips(const ToolMotions& motions);
  void substep(size_t index, const ToolMotions& motions, bool contacts);
  void queueStats();
  bool takeStats(layout::TickStats& stats, bool wait);
  void cut(const ToolMotions& motions);

  std::vector<StylusConfig> styluses_;
  Vector3f gravity_;
  double dt_safe_s_, dt_s_;
  int substeps_;
  LatticeBuffers buffers_;
  IntegratePass integrate_;
  MeasurePass measure_;
  std::optional<Tools> tools_;
  gpu::ReadbackRing stats_ring_;
  std::vector<layout::TickStats> finished_;  ///< came back while nobody asked
  std::vector<layout::ToolMotion> motions_;
  uint64_t tick_ = 0, cut_revision_ = 0;
  bool first_substep_ = true;
};

}  // namespace viscera
