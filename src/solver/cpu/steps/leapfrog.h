// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/cpu/kernels/tool_passes.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/state/cpu_stepper.h"
#include "solver/cpu/steps/network.h"

namespace viscera {

/// Leapfrog: SIMD kernels (kernels.h) brick by brick, where these are awake, and network.h for explicit connections.
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
  void sumWalls(CpuLattice& lattice, const Substep& step);
  void clearSums();
  void stepBricks(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, size_t first,
                  size_t end);
  void stepNetwork(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions);
  void touch(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, uint32_t brick);

  const Parallel& parallel_;
  Sleep& sleep_;
  CpuNetwork* network_;
  bool dashpot_;  ///< at least one body has a dashpot
  simd::BrickLeapfrog step_bricks_;
  simd::BrickPredict predict_bricks_;
  simd::BrickCells sum_cells_;
  simd::WallForces sum_walls_;
  AlignedVector<float> predicted_;           ///< [3 * slots], see kernels.h; empty if not needed
  std::vector<uint32_t> all_bricks_;         ///< all bricks, if predicted_ is needed
  std::vector<uint32_t> predicted_awake_;    ///< bricks that were awake when all of it was written
  AlignedVector<float> cell_sums_;           ///< [simd::kCellSums * bricks] N; empty without a law
  std::vector<uint32_t> cell_bricks_;        ///< bricks of the cells with corners in awake bricks
  std::vector<uint32_t> cell_bricks_awake_;  ///< bricks that were awake when these were listed
  AlignedVector<float> wall_forces_;         ///< [3 * slots] N; empty without cells in thin walls
  std::vector<uint32_t> wall_groups_;        ///< groups that act on awake bricks
  std::vector<uint32_t> wall_bricks_;        ///< bricks with nodes of these groups
  std::vector<uint8_t> wanted_;              ///< [bricks] scratch while listing
  AlignedVector<float> compensation_;        ///< [6 * slots], see kernels.h; empty without compensation
  simd::LeapfrogJob job_{};
  float deepest_m_;                 ///< largest value of surface_depth [m]
  std::vector<uint8_t> near_;       ///< [bricks]
  std::vector<uint16_t> strained_;  ///< [bricks]
  std::vector<float> speed2_;       ///< [bricks]
  CpuEdges edges_;
  std::vector<simd::Reach> reaches_;  ///< of probes and shafts in this substep, for nodes with explicit connections
  Portions portions_;                 ///< portions of bricks
};

}  // namespace viscera
