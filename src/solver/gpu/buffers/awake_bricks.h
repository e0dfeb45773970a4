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

/// Lists, made on the GPU, of the bricks that leapfrog steps, by the rule of the CPU's Sleep. Kernels are dispatched
/// indirectly over the lists, so the host need not know their lengths.
/// Owner of shaders/solver/step/awake_bricks.comp.
class AwakeBricks {
 public:
  /// @param speed_m_per_s  slower bricks fall asleep, > 0
  AwakeBricks(const Model& model, const FeatureSet& features, const LatticeBuffers& buffers, double speed_m_per_s);
  /// Returns whether the driver has enough storage blocks for the kernels.
  static bool fits(const FeatureSet& features);

  void bind() const;
  /// @name Waking bricks
  /// These take effect from the next substep on. The buffers must be bound.
  /// @{
  void wakeAll() { all_ = true; }
  void wakeNear(const std::vector<ToolBox>& boxes);  ///< at most kMostToolBoxes
  void wakeHeld();                                   ///< those with a held node
  /// Wakes bricks in the sphere that the blade may cut in, where springs were cut since the last substep.
  void wakeCut(uint32_t stylus);
  void wakeMarked();  ///< those that another kernel has marked as awake
  /// @}

  /// Lists what is awake, if that may have changed.
  void list();
  void dispatchNodes() const;  ///< dispatches the program in use over the awake nodes; after list()
  void dispatchCells() const;  ///< dispatches it over the cells around these
  /// Records that the awake bricks have made a substep; its result is not the current state yet. Every Sleep::kSubsteps
  /// they are checked; with cells in thin walls, with their longer reach of forces, every second substep.
  void passed(const Substep& step);
  /// Records a substep in which all bricks sleep and no kernel runs.
  void slept(const Substep& step);
  void restart();  ///< restarts the count of substeps
  void persist(Archive& archive);

  /// Returns the list of awake nodes. Its first sizeof(layout::AwakeList) bytes hold the counts.
  const gpu::RawBuffer& nodes() const { return nodes_; }
  /// Returns [bricks] 1 where awake; waits. Bricks that never sleep count as 0.
  std::vector<uint8_t> awake() const;

 private:
  void requireBricks(const Archive& archive, const std::vector<layout::SleepingBrick>& here) const;
  void persistList(Archive& archive, gpu::RawBuffer& list, size_t slots);
  bool isCheck(const Substep& step);
  void run(const gpu::Program& program);

  gpu::Program all_program_, near_, held_, cut_, marked_, check_program_, check_with_tools_, list_;
  gpu::Buffer<layout::SleepingBrick> bricks_;
  gpu::RawBuffer nodes_, cells_;
  float slow2_, deepest_m_, beside_;
  uint32_t group_size_;
  const int substeps_between_checks_;
  bool all_ = true, listed_ = false;
  double since_check_s_ = 0;
  int substeps_since_check_ = 0;
  uint32_t check_ = 0;
};

}  // namespace viscera
