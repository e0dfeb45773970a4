// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "model/scene/integrators.h"
#include "solver/contact/tool_port.h"
#include "solver/processes/port.h"
#include "solver/reference/reference_lattice.h"
#include "solver/reference/reference_obstacle.h"
#include "viscera/model/scene/solver_kinds.h"
#include "viscera/solver/solver.h"

namespace viscera {

class ReferenceEnvironment;

struct ReferenceOptions {
  ReferenceIntegrator integrator = ReferenceIntegrator::kLeapfrog;
  /// Largest speed at which a probe pushes a node out.
  double push_speed_m_per_s = std::numeric_limits<double>::infinity();
  /// A free node farther than this from its rest position, and moving away, is stopped.
  double sleep_distance_m = std::numeric_limits<double>::infinity();
  /// Wind, forces on bodies and contacts between nodes; null: none.
  std::shared_ptr<const ReferenceEnvironment> environment;
  /// [bodies] 1 where the tissue resists blades: then Blades cut it, and not the solver; empty: no body resists.
  std::vector<uint8_t> resists = {};
};

/// Motions of the obstacles in one substep, and the wind.
struct SubstepOutside {
  std::vector<layout::ObstacleMotion> obstacles;
  Vector3d wind_m_per_s = Vector3d::Zero();
};

/// Motions of all styluses in one substep.
using SubstepMotions = std::array<layout::ToolMotion, layout::kMaxStyluses>;

/// The lattice in float64 on one thread, written for evident correctness: the reference for all backends. Slots are
/// those of the model; physics.md 1, 2 and 5.
class ReferenceSolver : public ReferenceLattice, public ToolPort, public TissuePort {
 public:
  /// @param model  must outlive the solver   @param gravity_m_per_s2  tissue frame   @param dt_s  substep, > 0
  ReferenceSolver(const Model& model, const Vector3d& gravity_m_per_s2, double dt_s,
                  const ReferenceOptions& options = {});

  /// Advances by one substep with the actions of the styluses: cuts, then integrates with probes, held nodes and
  /// obstacles.
  /// @throws ConvergenceError  implicit Euler found no solution
  void substep(const SubstepMotions& motions = {}, const SubstepOutside& outside = {});
  /// Sets the following substeps [s]; leapfrog's next kick is the mean of the old and the new one.
  void setSubstep(double dt_s);
  double dt_s() const { return dt_s_; }
  /// Restarts time integration: the velocities are of the same time as the displacements, and the next kick is half a
  /// one.
  void restart() { first_ = true; }
  /// Restarts the counts of the impulses of styluses for Release and tickImpulse().
  void markTick() { impulse_before_n_s_ = impulse_n_s; }
  Vector3d tickImpulse(uint32_t stylus) const { return impulse_n_s[stylus] - impulse_before_n_s_[stylus]; }
  void takeHold(uint32_t stylus, const Pose& pose, double radius_m) override;
  void letGo(uint32_t stylus, const Release& release) override;
  void cut(uint32_t stylus, bool particles) override;
  /// @name TissuePort, with float32 numbers
  /// @{
  void readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m,
                 std::vector<Vector3f>& v_m_per_s) const override;
  void pushNodes(uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
                 const std::vector<Vector3f>& dv_m_per_s) override;
  void selectBody(size_t body) override { selected_body_ = body; }
  void cutAtRest(const layout::ToolMotion& sweep, bool particles) override;
  /// @}

  /// Returns the sum of spring, dashpot and volume forces on a node in the current state [N]; without gravity and drag.
  Vector3d force(uint32_t slot) const;
  /// Returns the kinetic, elastic and gravitational energy [J] of the current u and v.
  double energy() const;
  double kineticEnergy() const;
  double elasticEnergy() const { return elasticEnergy(u_m); }
  double gravityEnergy() const;
  Vector3d momentum() const;  ///< momentum of all nodes [N s]
  /// Returns the stiffness at the current u; see ReferenceLattice.
  Eigen::SparseMatrix<double> stiffnessMatrix() const { return stiffnessMatrix(u_m); }
  using ReferenceLattice::elasticEnergy;
  using ReferenceLattice::stiffnessMatrix;
  const Vector3d& gravity() const { return gravity_; }
  const ReferenceEnvironment* environment() const { return options_.environment.get(); }
  bool rests(uint32_t slot) const;  ///< fixed, or isolated and not held; ghosts: their row is broken
  /// Returns the state rounded to float32, as a kernel holds it.
  HostState state() const;

  Field u_m, v_m_per_s;                                              ///< [slots]
  std::array<Vector3d, layout::kMaxStyluses> impulse_n_s;            ///< momentum given by each stylus so far
  std::array<Vector3d, layout::kMaxObstacles> obstacle_impulse_n_s;  ///< momentum given by each obstacle so far
  uint32_t springs_cut = 0;

 private:
  Vector3d gravityAt(uint32_t slot) const;
  void cutWith(const layout::ToolMotion& m, bool particles, const std::vector<uint8_t>& spared);
  void leapfrog(Field& u_next, Field& v_next) const;
  void verletPaper(Field& u_next, Field& v_next) const;
  void implicitEuler(Field& u_next, Field& v_next);
  void applyTools(const SubstepMotions& motions, uint32_t slot, Vector3d& u_next, Vector3d& v_next);
  using Array2d = Eigen::Array2d;
  /// Correction that a probe demands of the point of a spring nearest to it (shaders/solver/tools/edges.glsl).
  struct EdgeShift {
    std::array<uint32_t, 2> slots;
    std::array<double, 2> shares;
    Array2d shifts;  ///< displacement out of the probe [m] and change of velocity [m/s]
    Vector3d normal;
  };
  std::optional<EdgeShift> shiftOfEdge(const layout::ToolMotion& motion, bool shaft, uint32_t a, uint32_t b,
                                       const Field& u_next, const Field& v_next) const;
  bool onSkin(uint32_t slot) const;
  void applyEdges(const layout::ToolMotion& motion, bool shaft, uint32_t stylus, Field& u_next, Field& v_next);
  void sleep(uint32_t slot, Vector3d& u_next, Vector3d& v_next) const;
  /// Returns the speed below which impacts do not bounce [m/s].
  double restingSpeed() const { return 4 * dt_s_ * gravity_.norm(); }
  void integrate(Field& u_next, Field& v_next);
  void blow(const SubstepOutside& outside, const Field& u_m, Field& v_m_per_s, Field* offset_m);
  void collide(Field& u_next, Field& v_next);
  void meetObstacles(Field& u_next, Field& v_next);
  friend class ImplicitContacts;
  friend class NodeContacts;
  Vector3d heldDisplacement(const layout::ToolMotion& motion, uint32_t slot) const;

  Vector3d gravity_;
  double dt_s_, last_dt_s_;
  ReferenceOptions options_;
  bool first_ = true;
  size_t selected_body_ = 0;
  SubstepMotions motions_{};                                       ///< motions of the substep
  std::vector<ReferenceObstacle> obstacles_;                       ///< obstacles in the substep
  std::array<Vector3d, layout::kMaxStyluses> impulse_before_n_s_;  ///< momentum given when the tick began
  Field grab_offsets_;  ///< [slots] position of a held node in the stylus frame [m]
};

}  // namespace viscera
