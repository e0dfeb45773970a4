// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <limits>

#include "viscera/math/types.h"
#include "viscera/tools/tick_contact.h"

namespace viscera {

using Eigen::Matrix3d;

/// What the scene says of the tissue that a tip may meet; where the estimate of its stiffness begins, and its bounds.
struct TissueConstants {
  double softest_pa = 1e4, stiffest_pa = 1e4;  ///< Young's moduli
  double poisson_ratio = 0.25;
  double tip_radius_m = 5e-3;
};

/// The tissue under one tip between two ticks (docs/haptics.md 2): an affine force
///
///     F(x) = f - K (x - a),   a the middle of the tip's way in the tick, f its force, K symmetric, 0 <= K <= limit
///
/// which a tick renews and which may be asked at any rate. A probe is never pulled: F . n < 0 gives nothing. From one
/// tick's F to the next one's the answer goes over evenly, both taken at the place that is asked for, so it has no
/// jumps. A blade's force ends at TickContact::limit_n: it is stiff while the edge is stuck, level while it cuts, and
/// falls as the hand goes back. A needle is held across from all sides, and along it as a blade is, both ways. A thread
/// pulls the way that it pulled the tick, no more than twice as much. No memory is allocated.
class ContactModel {
 public:
  /// Of an answer.
  struct Force {
    Vector3d force_n = Vector3d::Zero();
    Vector3d torque_nm = Vector3d::Zero();
    Matrix3d stiffness_n_per_m = Matrix3d::Zero();  ///< - dF/dx, 0 where the tip is free
  };

  explicit ContactModel(const TissueConstants& tissue) : tissue_(tissue) {}

  /// A tick's answer. Ticks of one contact that came one after the other tell the stiffness by what force and place
  /// changed (a secant, M. J. D. Powell's symmetric form of Broyden's); the first one has that of a sphere in a half
  /// space (H. Hertz 1882) or of one held within tissue.
  /// @param over_s  in which the answer goes over to it [s], a tick   @param now_s  never goes back
  void put(const TickContact& contact, double over_s, double now_s);
  /// The tissue is not known any more: what is answered goes to nothing over some time.
  void forget(double over_s, double now_s);
  /// @param tip_m  tissue frame   @param now_s  at or after the last put()
  Force at(const Vector3d& tip_m, double now_s) const;

  /// Where the last tick had the contact, and the model of that tick alone.
  const Vector3d& anchor_m() const { return now_.at_m; }
  const Vector3d& anchor_force_n() const { return now_.force_n; }
  const Matrix3d& stiffness_n_per_m() const { return now_.stiffness; }
  const Vector3d& normal() const { return now_.normal; }  ///< out of the tissue; 0 where the tip is free
  TickContact::Kind kind() const { return now_.kind; }

 private:
  struct Affine {
    TickContact::Kind kind = TickContact::Kind::kFree;
    Vector3d at_m = Vector3d::Zero(), force_n = Vector3d::Zero(), normal = Vector3d::Zero();
    Vector3d torque_nm = Vector3d::Zero();
    Matrix3d stiffness = Matrix3d::Zero();
    double limit_n = std::numeric_limits<double>::infinity();
    Vector3d along = Vector3d::Zero();  ///< of a needle, and its limits
    double ahead_n = 0, back_n = 0;
  };
  double goneOver(double now_s) const;
  Affine mixed(double now_s) const;
  static Force answer(const Affine& model, const Vector3d& tip_m);
  double stiffnessOf(double young_modulus_pa, const TickContact& contact) const;
  Matrix3d first(const TickContact& contact) const;
  Matrix3d learnt(const TickContact& contact, const Vector3d& at_m) const;
  Matrix3d bounded(const TickContact& contact, const Matrix3d& k) const;
  Affine leftBehind(const Vector3d& at_m, double now_s) const;
  void goOver(const Affine& next, double over_s, double now_s);

  TissueConstants tissue_;
  Affine before_, now_;
  Vector3d touched_m_ = Vector3d::Zero();  ///< where, and when, a tick had a contact last
  double touched_s_ = 0;
  double since_s_ = 0, over_s_ = 0;
};

}  // namespace viscera
