// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "solver/cpu/state/cpu_lattice.h"
#include "viscera/math/types.h"

namespace viscera {

class Archive;

/// Rule that determines which bricks are stepped; solver/gpu/buffers/awake_bricks.h follows the same rule. A brick is
/// awake if it, or one of the 26 around it, was touched or had a node faster than a speed within the last kQuiet_s. A
/// brick that falls asleep stops where it is.
class Sleep {
 public:
  /// Substeps between two checks. Disturbances need at least as many to cross the four cells of a brick: c_p dt <= 0.58
  /// h each.
  static constexpr int kSubsteps = 6;
  /// The same with cells in thin walls. There a force reaches three nodes in one substep, the width of a cell and of
  /// the row beyond it, so that a sleeping brick would miss more of its neighbours' motion.
  static constexpr int kSubstepsWithWalls = 2;
  static constexpr double kQuiet_s = 0.1;

  /// @param speed_m_per_s  0: nothing ever sleeps. Bricks without a node that may move are never awake.
  Sleep(const CpuLattice& lattice, double speed_m_per_s);

  void wakeAll(const CpuLattice& lattice);
  /// Wakes bricks with a node in a box.
  /// @param low, high  tissue frame [m]
  void wakeNear(const CpuLattice& lattice, const Vector3f& low, const Vector3f& high);
  void wake(uint32_t brick);
  /// Records that the awake bricks have made a substep. Every kSubsteps (with walls kSubstepsWithWalls) it checks which
  /// are fast, fall asleep or wake up.
  /// @param speed2  [bricks] largest |v|^2 of those awake [m2/s2]
  void passed(CpuLattice& lattice, float dt_s, const std::vector<float>& speed2);
  /// Restarts the count of substeps.
  void restart();

  const std::vector<uint32_t>& awake() const { return awake_; }  ///< awake bricks, ascending
  /// Returns the bricks with springs that may have changed since the last call: the awake ones, their neighbours, which
  /// share springs with them, and those that fell asleep.
  /// @param out  ascending; its memory is reused
  void takeChanged(const CpuLattice& lattice, std::vector<uint32_t>& out);

  void persist(Archive& archive);

 private:
  void requireListed(const Archive& archive) const;
  void check(CpuLattice& lattice, const std::vector<float>& speed2);
  void list(CpuLattice& lattice);
  void freeze(CpuLattice& lattice, uint32_t brick);

  float speed2_;
  int substeps_between_checks_;
  std::vector<float> quiet_s_;     ///< [bricks] time without fast nodes [s]
  std::vector<float> farthest_m_;  ///< [bricks] largest |u| when it fell asleep [m]
  std::vector<uint8_t> moves_;     ///< [bricks] 1: has nodes that may move
  std::vector<uint8_t> is_awake_, wanted_;
  std::vector<uint8_t> changed_;  ///< [bricks] 1: may have changed since takeChanged()
  std::vector<uint32_t> awake_;
  size_t moving_bricks_ = 0;
  double since_check_s_ = 0;
  int substeps_since_check_ = 0;
};

}  // namespace viscera
