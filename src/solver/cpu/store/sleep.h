// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "solver/cpu/store/cpu_lattice.h"
#include "viscera/math/types.h"

namespace viscera {

class Archive;

/// Which bricks are stepped (on the GPU by the same rule: solver/gpu/buffers/awake_bricks.h). A brick is awake while
/// it, or one of the 26 around it, has a node that was faster than a speed within the last kQuiet_s, or was touched. A
/// brick that falls asleep stands still where it is.
class Sleep {
 public:
  /// Substeps between two looks: disturbances cross the four cells of a brick, c_p dt <= 0.58 h each, in no fewer.
  static constexpr int kSubsteps = 6;
  /// The same with cells in thin walls: in one substep a force reaches three nodes, a cell's width and a row's beyond
  /// it, so that a brick that sleeps meanwhile would miss more of what is beside it.
  static constexpr int kSubstepsWithWalls = 2;
  static constexpr double kQuiet_s = 0.1;

  /// @param speed_m_per_s  0: nothing ever sleeps. Bricks without a node that may move are never awake.
  Sleep(const CpuLattice& lattice, double speed_m_per_s);

  void wakeAll(const CpuLattice& lattice);
  /// Wakes bricks with a node in a box. @param low, high  tissue frame [m]
  void wakeNear(const CpuLattice& lattice, const Vector3f& low, const Vector3f& high);
  void wake(uint32_t brick);
  /// Those awake have made a substep. After kSubsteps, with walls kSubstepsWithWalls, there is a look: who was fast,
  /// who falls asleep, who is woken. @param speed2  [bricks] largest |v|^2 of those awake [m2/s2]
  void passed(CpuLattice& lattice, float dt_s, const std::vector<float>& speed2);
  /// Substeps are counted from zero.
  void restart();

  const std::vector<uint32_t>& awake() const { return awake_; }  ///< ascending
  /// Bricks with springs that may have changed since the last call: of the awake, of those beside them, whose springs
  /// reach over, and of those that fell asleep. @param out  ascending; its memory is reused
  void takeChanged(const CpuLattice& lattice, std::vector<uint32_t>& out);

  void persist(Archive& archive);

 private:
  void requireListed(const Archive& archive) const;
  void look(CpuLattice& lattice, const std::vector<float>& speed2);
  void list(CpuLattice& lattice);
  void freeze(CpuLattice& lattice, uint32_t brick);

  float speed2_;
  int substeps_between_looks_;
  std::vector<float> quiet_s_;     ///< [bricks]
  std::vector<float> farthest_m_;  ///< [bricks] largest |u| when it fell asleep
  std::vector<uint8_t> moves_;     ///< [bricks] has nodes that may move
  std::vector<uint8_t> is_awake_, wanted_;
  std::vector<uint8_t> changed_;  ///< [bricks] beside those awake now
  std::vector<uint32_t> awake_;
  size_t moving_bricks_ = 0;
  double since_look_s_ = 0;
  int substeps_since_look_ = 0;
};

}  // namespace viscera
