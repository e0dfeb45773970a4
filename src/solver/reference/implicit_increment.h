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

/// The incremental potential, whose minimum is the next state.
class Increment : public Objective {
 public:
  Increment(const ReferenceSolver& solver, Field y_m)
      : solver_(solver), dt_s_(solver.dt_s()), y_m_(std::move(y_m)), frozen_u_m_(solver.u_m) {}

  /// Friction of a contact whose pressure is given: limit_n |slip|, slip along the surface from where the surface
  /// carries the node.
  struct Drag {
    uint32_t slot;
    Vector3d normal, carried_m;  ///< where the surface carries the node: displacement
    double limit_n;
    Vector3d slip(const Field& u_m) const {
      const Vector3d off = u_m[slot] - carried_m;
      return off - off.dot(normal) * normal;
    }
    /// On the node [N]. @param smooth_m  slips below it are no sliding yet
    Vector3d force(const Field& u_m, double smooth_m) const {
      const Vector3d s = slip(u_m);
      return -limit_n / std::hypot(s.norm(), smooth_m) * s;
    }
  };
  void setDrags(std::vector<Drag> drags) { drags_ = std::move(drags); }
  void setSmoothness(double smooth_m) { smooth_m_ = smooth_m; }
  const std::vector<Drag>& drags() const { return drags_; }
  double smoothness() const { return smooth_m_; }

  /// The directions of the dashpots: a potential for them exists only while these stand still.
  void freeze(const Field& u_m) override { frozen_u_m_ = u_m; }

  double value(const Field& u_m) const override {
    double sum = solver_.elasticEnergy(u_m) + dt_s_ * solver_.dissipation(frozen_u_m_, velocity(u_m));
    for (uint32_t slot : solver_.active) sum += 0.5 * inertia(slot) * (u_m[slot] - y_m_[slot]).squaredNorm();
    for (const Drag& d : drags_) sum += d.limit_n * std::hypot(d.slip(u_m).norm(), smooth_m_);
    return sum;
  }

  Field gradient(const Field& u_m) const override {
    Field out = solver_.elasticForces(u_m);
    const Field v = velocity(u_m);
    for (uint32_t slot : solver_.active) {
      out[slot] = inertia(slot) * (u_m[slot] - y_m_[slot]) - out[slot] - solver_.dashpotForce(frozen_u_m_, v, slot);
    }
    for (const Drag& d : drags_) out[d.slot] -= d.force(u_m, smooth_m_);
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
      for (int i = 0; i < 9; ++i)
        out.coeffRef(solver_.dof(d.slot, i / 3), solver_.dof(d.slot, i % 3)) += stiff(i / 3, i % 3);
    }
    return out;
  }

  double forceScale(const Field& u_m) const override {
    double scale = solver_.forceScale(u_m);
    for (uint32_t slot : solver_.active) scale = std::max(scale, inertia(slot) * (u_m[slot] - y_m_[slot]).norm());
    return scale;
  }

 private:
  double inertia(uint32_t slot) const {
    return solver_.mass(slot) * (1 + solver_.drag_per_s(slot) * dt_s_) / (dt_s_ * dt_s_);
  }
  Field velocity(const Field& u_m) const {
    Field v(u_m.size(), Vector3d::Zero());
    for (uint32_t slot : solver_.active) v[slot] = (u_m[slot] - solver_.u_m[slot]) / dt_s_;
    return v;
  }

  const ReferenceSolver& solver_;
  double dt_s_;
  Field y_m_, frozen_u_m_;
  std::vector<Drag> drags_;
  double smooth_m_ = 0;
};

}  // namespace viscera
