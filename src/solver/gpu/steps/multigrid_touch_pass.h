// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/gpu/buffers/multigrid_buffers.h"
#include "solver/gpu/steps/stepper.h"

namespace viscera {

class Archive;

/// What grips, probes and obstacles do to nodes in a step of multigrid, as multigrid::Touching has it for the CPU.
/// Owner of shaders/solver/multigrid/multigrid_touch.comp.
class MultigridTouchPass {
 public:
  MultigridTouchPass(const FeatureSet& features, const LatticeBuffers& buffers);

  /// Is anything about in a step?
  static bool isAbout(const Substep& step) { return step.tools || step.obstacle_count > 0; }
  void begin(const LatticeBuffers& buffers, const Substep& step) const;
  void persist(Archive& archive);
  /// Of the step that a stage ends at.
  void setShare(double share) { share_ = static_cast<float>(share); }
  void place(const LatticeBuffers& buffers, const Substep& step) const;  ///< moves what increments may not have
  void press(const LatticeBuffers& buffers, const Substep& step) const;  ///< says who is held
  void give(const LatticeBuffers& buffers, const Substep& step) const;   ///< ends the step

 private:
  enum Act { kBegin, kPlace, kPress, kGive, kActs };
  void run(Act act, const LatticeBuffers& buffers, const Substep& step) const;

  gpu::Program programs_[2][kActs];  ///< without and with tools
  gpu::Buffer<layout::vec4> contacts_;
  uint32_t group_size_, contact_rows_;
  bool obstacles_;
  float share_ = 1;
};

}  // namespace viscera
