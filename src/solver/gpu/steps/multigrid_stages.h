// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "solver/gpu/buffers/multigrid_buffers.h"
#include "solver/gpu/buffers/multigrid_levels.h"
#include "solver/gpu/steps/multigrid_touch_pass.h"
#include "solver/gpu/steps/stepper.h"
#include "solver/multigrid/steps/stage_work.h"

namespace viscera {

/// Vectors, products and sums of integrator multigrid on the GPU, on the order of which stepTrBdf2() and stepEuler()
/// decide. The host reads a few sums where something was evaluated, and once per iteration of conjugate gradients,
/// whose own numbers stay on the GPU. Owner of shaders/solver/multigrid/*.comp but those of contacts and coarse levels.
class MultigridStages final : public multigrid::StageWork {
 public:
  MultigridStages(const FeatureSet& features, const LatticeBuffers& buffers);

  /// Levels below the lattice for a stage. @param largest  of the smoother on the lattice
  struct Levels {
    const MultigridLevels* levels;
    float largest;
  };
  using FindLevels = std::function<Levels(const multigrid::Stage&)>;
  /// @param find  asked whenever a stage begins   @param stiffest_n_per_m  sum of a node's springs
  void setLevels(FindLevels find, double stiffest_n_per_m);
  /// @param fresh  how the last step ended is unknown   @param touch  of this step, begun; null: nothing is about
  void beginStep(const Substep& step, bool fresh, MultigridTouchPass* touch);
  /// The increment becomes the other state.
  void endStep();

  bool touching() const override { return touch_ != nullptr; }
  void begin(const multigrid::Stage& stage) override;
  multigrid::Energy start() override;
  void beginStage(uint32_t stage) override;
  void setShare(double share) override;
  Balance balance(bool tangent) override;
  Balance lookAgain(const Balance& known) override { return known; }
  multigrid::Energy energy() const override;
  double lag_j() const override;
  double given_j() const override;
  multigrid::Iteration iterate(bool first) override;
  void addSolution(bool tame) override;
  void become(uint32_t what, float share) override;

  void bind() const { own_.bind(); }
  void persist(Archive& archive) { own_.persist(archive); }
  void forgetTouched();  ///< nothing is about, nor was

 private:
  gpu::Program compiled(const char* name, std::initializer_list<const char*> more = {}) const;
  void use(const gpu::Program& program) const;
  void run(const gpu::Program& program, size_t count) const;
  void runNodes(const gpu::Program& program) const;
  void sum(uint32_t first_row, uint32_t rows, size_t summed, bool first = false) const;
  void linearise() const;
  void multiply(uint32_t x, uint32_t y, uint32_t base, bool subtract) const;
  void smooth(uint32_t r, float a, float b, bool first) const;
  void cycle() const;
  void dot(uint32_t x, uint32_t y, uint32_t row, bool first) const;

  const FeatureSet features_;
  const LatticeBuffers& buffers_;
  MultigridBuffers own_;
  MultigridCoarseKernels coarse_;
  gpu::Program begin_, stage_, increment_, place_, linearise_, product_, smooth_, dot_, direction_, advance_, balance_,
      mask_, sum_, tame_, end_;
  std::optional<gpu::Program> cells_, cells_product_;  ///< feature volume
  FindLevels find_;
  Levels levels_{};
  double stiffest_n_per_m_ = 0;
  multigrid::Stage of_;
  Substep step_;
  MultigridTouchPass* touch_ = nullptr;
  bool fresh_ = true;
  MultigridBuffers::Read read_{};  ///< of the last balance, or the start
};

}  // namespace viscera
