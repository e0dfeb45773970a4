// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solver/reference/newton.h"
#include "solver/reference/reference_solver.h"

namespace viscera {

/// The incremental potential. Its minimum is the next state.
class Increment : public Objective {
 public:
  Increment(const ReferenceSolver& solver, Field y_m)
      : solver_(solver), dt_s_(solver.dt_s()), y_m_(std::move(y_m)), frozen_u_m_(solver.u_m) {}

  /// Friction of a contact with a given pressure: limit_n |slip|. The slip is tangential, relative to the position to
  /// which the surface, or the other node, carries the node.
  struct Drag {
    uint32_t slot;
    Vector3d normal, carried_m;  ///< displacement to which the surface carries the node
    double limit_n;
    int64_t other = -1;  ///< slot of the other node, which receives the opposite force; negative: none
    Vector3d other_from_m = Vector3d::Zero();  ///< displacement of the other node before the substep
    Vector3d slip(const Field& u_m) const {
      Vector3d off = u_m[slot] - carried_m;
      if (other >= 0) off -= u_m[static_cast<size_t>(other)] - other_from_m;
      return off - off.dot(normal) * normal;
    }
    /// Returns the friction on the node [N]. @param smooth_m  slips below it do not count as sliding
    Vector3d force(const Field& u_m, double smooth_m) const {
      const Vector3d s = slip(u_m);
      return -limit_n / std::hypot(s.norm(), smooth_m) * s;
    }
  };
  void setDrags(std::vector<Drag> drags) { drags_ = std::move(drags); }
  void setSmoothness(double smooth_m) { smooth_m_ = smooth_m; }
  const std::vector<Drag>& drags() const { return drags_; }
  double smoothness() const { return smooth_m_; }

  /// Two nodes that come no nearer to each other than this: n . (du_a - du_b) >= -gap.
  struct Pair {
    uint32_t a, b;
    Vector3d normal;  ///< unit vector from b to a
    double gap_m;
    double pressure_n;  ///< pressure of the guess
  };
  /// @param stiffness_n_per_m  penalty stiffness by which violations add to the pressures
  void setPairs(std::vector<Pair> pairs, double stiffness_n_per_m) {
    pairs_ = std::move(pairs);
    pair_stiffness_n_per_m_ = stiffness_n_per_m;
  }
  double pressure(const Pair& p, const Field& u_m) const {
    const Vector3d apart = u_m[p.a] - solver_.u_m[p.a] - u_m[p.b] + solver_.u_m[p.b];
    return std::max(0.0, p.pressure_n - pair_stiffness_n_per_m_ * (p.normal.dot(apart) + p.gap_m));
  }

  /// Freezes the directions of the dashpots: they have a potential only while these are constant.
  void freeze(const Field& u_m) override { frozen_u_m_ = u_m; }

  double value(const Field& u_m) const override {
    double sum = solver_.elasticEnergy(u_m) + dt_s_ * solver_.dissipation(frozen_u_m_, velocity(u_m));
    for (uint32_t slot : solver_.active) sum += 0.5 * inertia(slot) * (u_m[slot] - y_m_[slot]).squaredNorm();
    for (const Drag& d : drags_) sum += d.limit_n * std::hypot(d.slip(u_m).norm(), smooth_m_);
    for (const Pair& p : pairs_) sum += std::pow(pressure(p, u_m), 2) / (2 * pair_stiffness_n_per_m_);
    return sum;
  }

  Field gradient(const Field& u_m) const override {
    Field out = solver_.elasticForces(u_m);
    const Field v = velocity(u_m);
    for (uint32_t slot : solver_.active) {
      out[slot] = inertia(slot) * (u_m[slot] - y_m_[slot]) - out[slot] - solver_.dashpotForce(frozen_u_m_, v, slot);
    }
    for (const Drag& d : drags_) {
      const Vector3d force = d.force(u_m, smooth_m_);
      out[d.slot] -= force;
      if (d.other >= 0) out[static_cast<size_t>(d.other)] += force;
    }
    for (const Pair& p : pairs_) {
      const Vector3d force = pressure(p, u_m) * p.normal;
      out[p.a] -= force;
      out[p.b] += force;
    }
    return out;
  }

  Eigen::SparseMatrix<double> hessian(const Field& u_m, ReferenceLattice::Curvature curvature) const override {
    Eigen::SparseMatrix<double> out = solver_.stiffnessMatrix(u_m, curvature, 1 / dt_s_);
    for (uint32_t slot : solver_.active) {
      for (int axis = 0; axis < 3; ++axis) {
        const int dof = solver_.dof(slot, axis);
        out.coeffRef(dof, dof) += inertia(slot);
      }
    }
    for (const Drag& d : drags_) {
      const Vector3d slip = d.slip(u_m);
      const double size = std::hypot(slip.norm(), smooth_m_);
      const Eigen::Matrix3d along = Eigen::Matrix3d::Identity() - d.normal * d.normal.transpose();
      const Eigen::Matrix3d stiff = d.limit_n / size * (along - slip * slip.transpose() / (size * size));
      addBetween(d.slot, d.other, stiff, out);
    }
    for (const Pair& p : pairs_) {
      if (pressure(p, u_m) > 0) addBetween(p.a, p.b, pair_stiffness_n_per_m_ * p.normal * p.normal.transpose(), out);
    }
    return out;
  }

  double forceScale(const Field& u_m) const override {
    double scale = solver_.forceScale(u_m);
    for (uint32_t slot : solver_.active) scale = std::max(scale, inertia(slot) * (u_m[slot] - y_m_[slot]).norm());
    return scale;
  }

 private:
  /// Adds the curvature of a term that depends on u_a - u_b alone. @param b  negative: on u_a alone
  void addBetween(uint32_t a, int64_t b, const Eigen::Matrix3d& stiff, Eigen::SparseMatrix<double>& out) const {
    const auto add = [&](uint32_t row, uint32_t column, double sign) {
      for (int i = 0; i < 9; ++i)
        out.coeffRef(solver_.dof(row, i / 3), solver_.dof(column, i % 3)) += sign * stiff(i / 3, i % 3);
    };
    add(a, a, 1);
    if (b < 0) return;
    const auto other = static_cast<uint32_t>(b);
    add(other, other, 1);
    add(a, other, -1);
    add(other, a, -1);
  }

 public:
  /// Returns m (1 + gamma dt)/dt^2 [N/m].
  double inertia(uint32_t slot) const {
    return solver_.mass(slot) * (1 + solver_.mass_damping_per_s(slot) * dt_s_) / (dt_s_ * dt_s_);
  }

 private:
  Field velocity(const Field& u_m) const {
    Field v(u_m.size(), Vector3d::Zero());
    for (uint32_t slot : solver_.active) v[slot] = (u_m[slot] - solver_.u_m[slot]) / dt_s_;
    return v;
  }

  const ReferenceSolver& solver_;
  double dt_s_;
  Field y_m_, frozen_u_m_;
  std::vector<Drag> drags_;
  std::vector<Pair> pairs_;
  double smooth_m_ = 0, pair_stiffness_n_per_m_ = 1;
};

}  // namespace viscera
