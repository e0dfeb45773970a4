// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/linear_contact.h"

#include <Eigen/SparseCholesky>
#include <cmath>

#include "bench/harness/specimens/block.h"

namespace viscera::bench {

namespace {

/// Returns the displacement in an elastic half-space under a force of 1 N on its surface, along z into it (Boussinesq).
/// @param x  position relative to the point of application, z > 0 inside [m]
Vector3d boussinesq(const Vector3d& x, double shear_pa, double nu) {
  const double rho = x.norm(), r2 = rho * rho;
  const double side = x.z() / (r2 * rho) - (1 - 2 * nu) / (rho * (rho + x.z()));
  const double down = x.z() * x.z() / (r2 * rho) + 2 * (1 - nu) / rho;
  return Vector3d(side * x.x(), side * x.y(), down) / (4 * M_PI * shear_pa);
}

/// The quarter block x, y >= 0 and its rest stiffness, split into free and prescribed degrees of freedom.
class QuarterBlock {
 public:
  QuarterBlock(int cells, double spacing_m, const MaterialConfig& material, FarField far_field)
      : model_(blockModel(Vector3i::Constant(cells), spacing_m, material)),
        lattice_(model_, Vector3d::Zero(), 1),
        cells_(cells),
        nu_(material.poisson_ratio),
        shear_pa_(material.young_modulus_pa / (2 * (1 + nu_))),
        far_field_(far_field) {
    std::vector<int> free_of(static_cast<size_t>(lattice_.dofs()), -1);
    for (uint32_t slot : lattice_.active) {
      for (int axis = 0; axis < 3; ++axis) {
        if (isFree(node(slot), axis)) free_of[static_cast<size_t>(lattice_.dof(slot, axis))] = free_++;
      }
    }
    split(free_of);
  }

  /// Returns the displacement of every candidate if a node at the top and its mirror images are each pressed by 1 N
  /// [m].
  Eigen::VectorXd sinking(uint32_t pressed, const std::vector<uint32_t>& candidates) const {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(free_);
    load[index_[dof(pressed, 2)]] = -images(pressed) / 4.0;  // a node on a plane of symmetry is shared
    if (far_field_ == FarField::kHalfSpace) load -= coupling_ * farDisplacement(pressed);
    const Eigen::VectorXd u = solver_.solve(load);
    Eigen::VectorXd out(static_cast<Eigen::Index>(candidates.size()));
    for (size_t i = 0; i < candidates.size(); ++i)
      out[static_cast<Eigen::Index>(i)] = -u[index_[dof(candidates[i], 2)]];
    return out;
  }
  int images(uint32_t slot) const { return (node(slot).x() > 0 ? 2 : 1) * (node(slot).y() > 0 ? 2 : 1); }
  /// Returns the free nodes of the top within a distance of the axis.
  std::vector<uint32_t> topNodes(double reach_m) const {
    std::vector<uint32_t> out;
    for (uint32_t slot : lattice_.active) {
      const Vector3i n = node(slot);
      if (n.z() == cells_ && isFree(n, 2) && distance(slot) <= reach_m) out.push_back(slot);
    }
    return out;
  }
  double distance(uint32_t slot) const { return lattice_.restPosition(slot).head<2>().norm(); }

 private:
  Vector3i node(uint32_t slot) const { return model_.bodies[0].lattice.nodeAt(slot); }
  size_t dof(uint32_t slot, int axis) const { return static_cast<size_t>(lattice_.dof(slot, axis)); }
  bool isFree(const Vector3i& n, int axis) const {
    if (n.z() == 0) return false;
    if (far_field_ == FarField::kHalfSpace && (n.x() == cells_ || n.y() == cells_)) return false;
    return !(axis < 2 && n[axis] == 0);
  }
  void split(const std::vector<int>& free_of) {
    const Eigen::SparseMatrix<double> k = lattice_.stiffnessMatrix(lattice_.u_m);
    std::vector<Eigen::Triplet<double>> inside, across;
    for (int column = 0; column < k.outerSize(); ++column) {
      const int free_column = free_of[static_cast<size_t>(column)];
      for (Eigen::SparseMatrix<double>::InnerIterator it(k, column); it; ++it) {
        const int free_row = free_of[static_cast<size_t>(it.row())];
        if (free_row < 0) continue;
        if (free_column >= 0) inside.emplace_back(free_row, free_column, it.value());
        if (free_column < 0) across.emplace_back(free_row, column, it.value());
      }
    }
    Eigen::SparseMatrix<double> matrix(free_, free_);
    matrix.setFromTriplets(inside.begin(), inside.end());
    coupling_.resize(free_, lattice_.dofs());
    coupling_.setFromTriplets(across.begin(), across.end());
    solver_.compute(matrix);
    index_ = free_of;
  }
  /// Returns [dofs] displacements of the far faces; zero elsewhere.
  Eigen::VectorXd farDisplacement(uint32_t pressed) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(lattice_.dofs());
    const Vector3d top = lattice_.restPosition(pressed);
    for (uint32_t slot : lattice_.active) {
      const Vector3i n = node(slot);
      if (n.z() != 0 && n.x() != cells_ && n.y() != cells_) continue;
      Vector3d sum = Vector3d::Zero();
      for (double sx : {-1.0, 1.0}) {
        for (double sy : {-1.0, 1.0}) {
          const Vector3d from = lattice_.restPosition(slot) - Vector3d(sx * top.x(), sy * top.y(), top.z());
          const Vector3d u = boussinesq({from.x(), from.y(), -from.z()}, shear_pa_, nu_);
          sum += Vector3d(u.x(), u.y(), -u.z());
        }
      }
      out.segment<3>(lattice_.dof(slot, 0)) = sum * images(pressed) / 4.0;  // coinciding images count once
    }
    return out;
  }

  Model model_;
  ReferenceSolver lattice_;
  int cells_, free_ = 0;
  double nu_, shear_pa_;
  FarField far_field_;
  std::vector<int> index_;  ///< [dofs] index among the free ones, or -1
  Eigen::SparseMatrix<double> coupling_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace

LinearContact::LinearContact(int cells, double spacing_m, const MaterialConfig& material, FarField far_field,
                             double reach_m) {
  const QuarterBlock block(cells, spacing_m, material, far_field);
  const std::vector<uint32_t> nodes = block.topNodes(reach_m);
  const auto count = static_cast<Eigen::Index>(nodes.size());
  compliance_.resize(count, count);
  for (size_t j = 0; j < nodes.size(); ++j) {
    candidates_.push_back({block.distance(nodes[j]), block.images(nodes[j])});
    compliance_.col(static_cast<Eigen::Index>(j)) = block.sinking(nodes[j], nodes);
  }
}

LinearContact::Result LinearContact::press(double radius_m, double depth_m) const {
  // Every candidate is at the sphere or deeper, is pressed or free, and one of the two conditions is an equality.
  const auto count = static_cast<Eigen::Index>(candidates_.size());
  Eigen::VectorXd wanted(count), force = Eigen::VectorXd::Zero(count);
  std::vector<bool> touched(candidates_.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const double r = candidates_[static_cast<size_t>(i)].distance_m;
    wanted[i] = depth_m - (radius_m - std::sqrt(radius_m * radius_m - r * r));
    touched[static_cast<size_t>(i)] = wanted[i] > 0;
  }
  for (bool changed = true; changed;) {
    std::vector<Eigen::Index> active;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (touched[static_cast<size_t>(i)]) active.push_back(i);
    }
    force.setZero();
    const Eigen::MatrixXd among = compliance_(active, active);
    const Eigen::VectorXd depth = wanted(active), pressed = among.lu().solve(depth);
    force(active) = pressed;
    const Eigen::VectorXd sunk = compliance_ * force;
    changed = false;
    for (Eigen::Index i = 0; i < count; ++i) {
      const size_t c = static_cast<size_t>(i);
      const bool keep = touched[c] ? force[i] >= 0 : sunk[i] < wanted[i] - 1e-12 * depth_m;
      changed |= keep != touched[c];
      touched[c] = keep;
    }
  }
  Result out;
  for (size_t c = 0; c < candidates_.size(); ++c) {
    out.force_n += candidates_[c].images * force[static_cast<Eigen::Index>(c)];
    out.touched += touched[c] ? candidates_[c].images : 0;
  }
  return out;
}

double hertzForce(const MaterialConfig& material, double radius_m, double depth_m) {
  const double nu = material.poisson_ratio;
  return 4.0 / 3 * material.young_modulus_pa / (1 - nu * nu) * std::sqrt(radius_m) * std::pow(depth_m, 1.5);
}

}  // namespace viscera::bench
