// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

/// Returns the strains of a body's prestress: [1 + parts], by label; label 0 is for cells without a part.
std::vector<Eigen::Matrix3d> strainsByLabel(const Body& body);

/// Checks the strains of a body's prestress.
/// @throws SceneError  a strain would make tissue at rest shorter or longer than accepted; names body and key
void requirePrestrains(const Body& body);

/// Tensions of a body that exert no net force on any free node in its shape. Of the requested tensions it keeps what
/// remains after nodes move to equilibrium, to first order; the given shape then counts as the rest shape.
class PrestressBalance {
 public:
  virtual ~PrestressBalance() = default;

  /// Balances the requested tensions by conjugate gradients. Call once.
  /// @return a line for a person: how much of them is kept   @throws SceneError  there is no balance
  std::string find();

 protected:
  using Field = std::vector<Vector3d>;  ///< [slots]
  explicit PrestressBalance(const Body& body) : body_(body) {}

  virtual double energy() const = 0;                               ///< energy of the tensions, in any unit
  virtual void pulls(Field& out) const = 0;                        ///< adds their forces on nodes [N]
  virtual void multiply(const Field& at_m, Field& out) const = 0;  ///< adds the stiffness times displacements [N]
  virtual void addStiffness(std::vector<double>& sums) const = 0;  ///< adds approximate stiffnesses per node [N/m]
  virtual void take(const Field& at_m) = 0;  ///< adds the change of the tensions due to displacements

  const Body& body_;
  double largest_n_ = 0;  ///< largest requested tension [N]

 private:
  void free(Field& forces) const;
  Field pullsNow() const;
};

}  // namespace viscera
