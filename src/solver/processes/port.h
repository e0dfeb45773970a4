// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "viscera/layout/tool_motion.h"
#include "viscera/math/types.h"

namespace viscera {

/// Slots are read and pushed in runs of eight consecutive slots, the first a multiple of eight.
constexpr size_t kRunSlots = 8;
/// One number per axis and slot of runs: [3][kRunSlots * runs].
using RunPlanes = std::array<std::vector<float>, 3>;

/// Interface by which processes (process.h) read and change the tissue after a substep: some nodes, and springs to cut.
/// Every backend implements it, and test/solver/processes/port_gl_test.cpp tests all of them.
class TissuePort {
 public:
  virtual ~TissuePort() = default;
  /// Reads the current displacements and velocities. @param slots  of nodes   @param u_m, v_m_per_s  out: [slots]
  virtual void readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m,
                         std::vector<Vector3f>& v_m_per_s) const = 0;
  /// Changes velocities, and displacements as if the last substep had used the changed velocities. The momentum is
  /// added to the reaction of a stylus. Fixed nodes do not move. @param stylus  kMaxStyluses: none
  virtual void pushNodes(uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
                         const std::vector<Vector3f>& dv_m_per_s) = 0;
  /// @name The same for whole runs: [kRunSlots * runs] by axis. They call readNodes() and pushNodes() unless a backend
  /// has a faster implementation. @param runs  their first slots
  /// @{
  virtual void readRuns(const std::vector<uint32_t>& runs, RunPlanes& u_m, RunPlanes& v_m_per_s) const;
  virtual void pushRuns(uint32_t stylus, float dt_s, const std::vector<uint32_t>& runs, const RunPlanes& dv_m_per_s);
  /// @}
  /// Selects the body for the following calls of cutAtRest().
  virtual void selectBody(size_t body) = 0;
  /// Cuts the springs that a sweep crosses with the nodes at their rest positions.
  /// @param particles  erases the nodes near it instead, as ToolPort::cut() does
  virtual void cutAtRest(const layout::ToolMotion& sweep, bool particles) = 0;
};

}  // namespace viscera
