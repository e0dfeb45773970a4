// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

/// Returns the strains that a body's prestress asks for: [1 + parts], by label; label 0 has those of no part.
std::vector<Eigen::Matrix3d> strainsByLabel(const Body& body);

/// @throws SceneError  a strain would leave tissue shorter or longer at rest than it bears; names body and key
void requirePrestrains(const Body& body);

/// Tensions of a body that pull at no free node in the shape that it has: of those asked for what is left when nodes go
/// where they lead, to first order, and the shape is then called the one at rest.
class PrestressBalance {
 public:
  virtual ~PrestressBalance() = default;

  /// Balances what was asked for, by conjugate gradients. Once.
  /// @return a line for a person: how much of it is kept   @throws SceneError  there is no balance
  std::string find();

 protected:
  using Field = std::vector<Vector3d>;  ///< [slots]
  explicit PrestressBalance(const Body& body) : body_(body) {}

  virtual double energy() const = 0;                               ///< of the tensions, in any unit
  virtual void pulls(Field& out) const = 0;                        ///< adds what they do to nodes [N]
  virtual void multiply(const Field& at_m, Field& out) const = 0;  ///< adds the stiffness times displacements [N]
  virtual void addStiffness(std::vector<double>& sums) const = 0;  ///< adds about what each node has of it [N/m]
  virtual void take(const Field& at_m) = 0;  ///< adds to the tensions what displacements give them

  const Body& body_;
  double largest_n_ = 0;  ///< of what was asked for

 private:
  void free(Field& forces) const;
  Field pullsNow() const;
};

}  // namespace viscera
