// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/steps/network.h"
#include "solver/cpu/store/cpu_stepper.h"
#include "solver/cpu/text/tool_passes.h"

namespace viscera {

/// Leapfrog, brick by brick where they are awake: SIMD kernels (kernels.h), and network.h for explicit connections.
class CpuLeapfrog : public CpuStepper {
 public:
  CpuLeapfrog(const CpuLattice& lattice, const CpuParts& parts);
  void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) override;
  void restart() override;
  void persist(Archive& archive, CpuLattice& lattice) override;

 private:
  void stepAwake(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions);
  void predict(const Substep& step);
  void sumCells(CpuLattice& lattice);
  void sumWalls(CpuLattice& lattice);
  void forgetSums();
  void stepBricks(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, size_t first,
                  size_t end);
  void stepNetwork(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions);
  void touch(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, uint32_t brick);

  const Parallel& parallel_;
  Sleep& sleep_;
  CpuNetwork* network_;
  bool dashpot_;  ///< some body has one
  simd::BrickLeapfrog step_bricks_;
  simd::BrickPredict predict_bricks_;
  simd::BrickCells sum_cells_;
  simd::WallForces sum_walls_;
  AlignedVector<float> predicted_;           ///< [3 * slots], see kernels.h; empty where it is not needed
  std::vector<uint32_t> all_bricks_;         ///< where it is
  std::vector<uint32_t> predicted_awake_;    ///< those awake when it was written as a whole
  AlignedVector<float> cell_sums_;           ///< [simd::kCellSums * bricks] N; empty without a law
  std::vector<uint32_t> cell_bricks_;        ///< whose cells the nodes of those awake are corners of
  std::vector<uint32_t> cell_bricks_awake_;  ///< those awake when they were listed
  AlignedVector<float> wall_forces_;         ///< [3 * slots] N; empty without such cells
  std::vector<uint32_t> wall_groups_;        ///< that act on bricks that are awake
  std::vector<uint32_t> wall_bricks_;        ///< that they look at
  std::vector<uint8_t> wanted_;              ///< [bricks] while they are listed
  AlignedVector<float> compensation_;        ///< [6 * slots], see kernels.h; empty without compensation
  simd::LeapfrogJob job_{};
  float deepest_m_;                 ///< of surface_depth
  std::vector<uint8_t> near_;       ///< [bricks]
  std::vector<uint16_t> strained_;  ///< [bricks]
  std::vector<float> speed2_;       ///< [bricks]
  CpuEdges edges_;
  std::vector<NodeReach> reaches_;  ///< of probes in this substep, for nodes with explicit connections
  Portions portions_;               ///< of bricks
};

}  // namespace viscera
