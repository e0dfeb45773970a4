// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/solver/solver.h"

namespace viscera {

/// The lattice in float64 on one thread, written to be obviously right: the truth that backends are held to.
/// Slots are those of the model; physics.md 1, 2 and 5.
class ReferenceSolver {
 public:
  /// @param model  must outlive the solver   @param gravity_m_per_s2  tissue frame   @param dt_s  substep, > 0
  ReferenceSolver(const Model& model, const Vector3d& gravity_m_per_s2, double dt_s);

  /// One leapfrog substep with what the styluses do in it: cut, then integrate with probes and held nodes.
  void substep(const std::array<layout::ToolMotion, layout::kMaxStyluses>& motions = {});
  void takeHold(uint32_t stylus, const Pose& pose, double radius_m);
  void letGo(uint32_t stylus, double release_speed_m_per_s);

  /// Sum of spring and dashpot forces on a node [N].
  Vector3d force(uint32_t slot) const;
  /// Kinetic plus elastic plus gravitational energy [J] of the current u and v.
  double energy() const;
  Vector3d restPosition(uint32_t slot) const;

  std::vector<uint32_t> active;                            ///< [active] slots
  std::vector<Vector3d> u_m, v_m_per_s;                    ///< [slots]
  std::vector<layout::NodeBits> nodes;                     ///< [slots]
  std::array<Vector3d, layout::kMaxStyluses> impulse_n_s;  ///< momentum given by each stylus so far
  uint32_t springs_cut = 0;

 private:
  struct Neighbor {
    uint32_t slot;
    Vector3d offset_m;  ///< rest offset
    double rest_m;      ///< its length
  };
  const Neighbor& neighbor(uint32_t slot, uint32_t spring) const {
    return neighbors_[slot * layout::kSpringsPerNode + spring];
  }
  double stiffness(uint32_t slot, uint32_t spring) const;
  double mass(uint32_t slot) const;
  const layout::BodyParams& body(uint32_t slot) const { return params_[nodes[slot].hi >> layout::kBodyShift]; }
  void cut(const layout::ToolMotion& motion);
  void applyTools(const std::array<layout::ToolMotion, layout::kMaxStyluses>& motions, uint32_t slot, Vector3d& u_next,
                  Vector3d& v_next);

  Vector3d gravity_;
  double dt_s_;
  bool first_ = true;
  std::vector<layout::BodyParams> params_;
  std::vector<Neighbor> neighbors_;  ///< [slots * 18]
  std::vector<Vector3d> rest_m_;     ///< [slots]
  std::vector<Vector3d> grab_offsets_;
};

}  // namespace viscera
