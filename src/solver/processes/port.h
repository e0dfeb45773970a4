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

/// Slots are read and pushed in runs of eight that follow each other, the first a multiple of eight.
constexpr size_t kRunSlots = 8;
/// One number per axis and slot of runs: [3][kRunSlots * runs].
using RunPlanes = std::array<std::vector<float>, 3>;

/// What processes (process.h) read and change of the tissue after a substep: some nodes, and springs to cut. Every
/// backend implements it, and test/solver/processes/port_gl_test.cpp holds all of them to it.
class TissuePort {
 public:
  virtual ~TissuePort() = default;
  /// Reads displacements and velocities as they are now. @param slots  of nodes   @param u_m, v_m_per_s  as long as
  /// slots
  virtual void readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m,
                         std::vector<Vector3f>& v_m_per_s) const = 0;
  /// Changes velocities, and displacements as if the substep that was just made had known; the momentum goes to the
  /// reaction of a stylus. Fixed nodes stay. @param stylus  kMaxStyluses: to none
  virtual void pushNodes(uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
                         const std::vector<Vector3f>& dv_m_per_s) = 0;
  /// @name The same of whole runs: [kRunSlots * runs] by axis. Calls readNodes() and pushNodes() unless a backend has
  /// something faster. @param runs  their first slots
  /// @{
  virtual void readRuns(const std::vector<uint32_t>& runs, RunPlanes& u_m, RunPlanes& v_m_per_s) const;
  virtual void pushRuns(uint32_t stylus, float dt_s, const std::vector<uint32_t>& runs, const RunPlanes& dv_m_per_s);
  /// @}
  /// Selects the body whose springs cutAtRest() cuts from now on.
  virtual void selectBody(size_t body) = 0;
  /// Cuts the springs that a sweep crosses where the nodes are at rest.
  /// @param particles  erases the nodes near it instead, as ToolTarget::cut() does
  virtual void cutAtRest(const layout::ToolMotion& sweep, bool particles) = 0;
};

}  // namespace viscera
