// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gpu/program.h"
#include "layout/awake_bricks.h"
#include "solver/contact/tool_boxes.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"
#include "solver/tissue/substep.h"

namespace viscera {

class Archive;

/// Which bricks leapfrog steps on the GPU, by the rule of the CPU's Sleep, found and listed there: kernels are
/// dispatched over what is awake and the host need not know how much that is.
/// Owner of shaders/solver/step/awake_bricks.comp.
class AwakeBricks {
 public:
  /// @param speed_m_per_s  what is slower falls asleep, > 0
  AwakeBricks(const Model& model, const FeatureSet& features, const LatticeBuffers& buffers, double speed_m_per_s);
  /// Has the driver enough storage blocks for the kernels?
  static bool fits(const FeatureSet& features);

  void bind() const;
  /// @name What wakes bricks
  /// From the next substep on. The buffers must be bound.
  /// @{
  void wakeAll() { all_ = true; }
  void wakeNear(const std::vector<ToolBox>& boxes);  ///< at most kMaxStyluses
  void wakeHeld();                                   ///< those with a node that is held
  /// Those in the sphere that the blade may cut in, where springs were cut since the last substep.
  void wakeCut(uint32_t stylus);
  void wakeMarked();  ///< another kernel has marked bricks as awake
  /// @}

  /// Lists what is awake, where that may have changed.
  void list();
  void dispatchNodes() const;  ///< of the program in use, over the nodes that are awake; after list()
  void dispatchCells() const;  ///< over the cells around these
  /// They have made a substep, whose result is not the current state yet. After every Sleep::kSubsteps there is a look;
  /// with cells in thin walls, whose forces reach farther, after every second one.
  void passed(const Substep& step);
  /// The same where all sleep and no kernel runs.
  void slept(const Substep& step);
  void restart();  ///< substeps are counted from zero
  void persist(Archive& archive);

  /// The first sizeof(layout::AwakeList) bytes say how much is awake.
  const gpu::RawBuffer& nodes() const { return nodes_; }
  /// [bricks] 1 where awake; waits. Bricks that never sleep are not.
  std::vector<uint8_t> awake() const;

 private:
  void requireBricks(const Archive& archive, const std::vector<layout::SleepingBrick>& here) const;
  void persistList(Archive& archive, gpu::RawBuffer& list, size_t slots);
  bool isLook(const Substep& step);
  void run(const gpu::Program& program);

  gpu::Program all_program_, near_, held_, cut_, marked_, look_program_, look_with_tools_, list_;
  gpu::Buffer<layout::SleepingBrick> bricks_;
  gpu::RawBuffer nodes_, cells_;
  float slow2_, deepest_m_, beside_;
  uint32_t group_size_;
  const int substeps_between_looks_;
  bool all_ = true, listed_ = false;
  double since_look_s_ = 0;
  int substeps_since_look_ = 0;
  uint32_t look_ = 0;
};

}  // namespace viscera
