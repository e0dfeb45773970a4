// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <limits>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/tools/tick_contact.h"

namespace VISCERA_PUBLIC viscera {

using Eigen::Matrix3d;

/// Constants of the tissue that a tip may touch. They give the initial estimate of its stiffness and the bounds of the
/// estimate.
struct TissueConstants {
  double softest_pa = 1e4, stiffest_pa = 1e4;  ///< smallest and largest Young's modulus [Pa]
  double poisson_ratio = 0.25;
  double tip_radius_m = 5e-3;
};

/// Local model of the tissue under one tip between two ticks (docs/haptics.md 2): an affine force
///
///     F(x) = f - K (x - a),   a the middle of the tip's path in the tick, f its force, K symmetric, 0 <= K <= limit
///
/// Every tick updates the model; it can be evaluated at any rate. A probe is never pulled: the force is zero where
/// F . n < 0. The force is blended evenly from one tick's model to the next, both evaluated at the current position, so
/// it has no jumps.
/// A blade's force is limited to TickContact::limit_n: it is stiff while the edge is stuck, constant while it cuts, and
/// falls as the blade moves back. A needle is held by tissue across its shaft from all sides; along the shaft its force
/// is limited in both directions, as a blade's is. A suture pulls in the direction of the tick's force, with at most
/// twice its size. No function allocates memory.
class VISCERA_PUBLIC ContactModel {
 public:
  /// The result of an evaluation.
  struct Force {
    Vector3d force_n = Vector3d::Zero();
    Vector3d torque_nm = Vector3d::Zero();
    Matrix3d stiffness_n_per_m = Matrix3d::Zero();  ///< - dF/dx; 0 if the tip is free
  };

  explicit ContactModel(const TissueConstants& tissue) : tissue_(tissue) {}

  /// Updates the model with a tick. Successive ticks of one contact determine the stiffness from the changes of force
  /// and position (a secant, M. J. D. Powell's symmetric form of Broyden's update). The first tick of a contact uses
  /// the stiffness of a sphere in contact with a half space (H. Hertz 1882), or of a sphere held within tissue.
  /// @param over_s  time of the blend to this tick [s], the length of a tick   @param now_s  never goes back
  void put(const TickContact& contact, double over_s, double now_s);
  /// Discards the model: the force goes to zero within over_s.
  void clear(double over_s, double now_s);
  /// Returns the force at a position. @param tip_m  tissue frame   @param now_s  not before the last put()
  Force at(const Vector3d& tip_m, double now_s) const;

  /// Returns a, f and K of the last tick's model alone, without the blend.
  const Vector3d& anchor_m() const { return now_.at_m; }
  const Vector3d& anchor_force_n() const { return now_.force_n; }
  const Matrix3d& stiffness_n_per_m() const { return now_.stiffness; }
  const Vector3d& normal() const { return now_.normal; }  ///< normal out of the tissue; 0 if the tip is free
  TickContact::Kind kind() const { return now_.kind; }

 private:
  struct Affine {
    TickContact::Kind kind = TickContact::Kind::kFree;
    Vector3d at_m = Vector3d::Zero(), force_n = Vector3d::Zero(), normal = Vector3d::Zero();
    Vector3d torque_nm = Vector3d::Zero();
    Matrix3d stiffness = Matrix3d::Zero();
    double limit_n = std::numeric_limits<double>::infinity();
    Vector3d along = Vector3d::Zero();  ///< direction of a needle, and the limits of its force along it
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
  Vector3d touched_m_ = Vector3d::Zero();  ///< position and time of the last tick with a contact
  double touched_s_ = 0;
  double since_s_ = 0, over_s_ = 0;
};

}  // namespace viscera
