// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/walls.h"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include "solver/reference/statics.h"

namespace viscera::bench {

namespace {

constexpr int kSamples = 6;           ///< per edge of a cell that is completely inside or outside
constexpr int kFineSamples = 24;      ///< for other cells: along a rod, errors of the area do not average out
constexpr double kLeastShare = 0.01;  ///< least share of a cell that is kept
constexpr double kSmall = 1e-3;       ///< largest displacement over the spacing when kernels are evaluated

/// The part of one cell inside the wall, and the load on its corners.
struct FilledCell {
  double inside = 0;  ///< share of the samples that are inside
  CellFill fill;
  std::array<Vector3d, 8> load_n;
};

/// Cells of the grid, in the axes of the grid.
class Grid {
 public:
  Grid(const Wall& wall, const Placing& placing, double spacing_m)
      : wall_(wall), placing_(placing), spacing_m_(spacing_m) {
    const Vector3d reach = placing.turn.cwiseAbs() * wall.half_m / spacing_m;
    low_ = (-reach).array().floor().cast<int>() - 1;
    solid_.spacing_m = spacing_m;
    solid_.cells = (reach.array().ceil().cast<int>() + 2 - low_.array()).matrix();
    solid_.part_names = {wall.name};
    solid_.labels.assign(static_cast<size_t>(solid_.cells.prod()), 0);
    for (int z = 0; z < solid_.cells.z(); ++z)
      for (int y = 0; y < solid_.cells.y(); ++y)
        for (int x = 0; x < solid_.cells.x(); ++x) fillCell({x, y, z});
  }
  const Solid& solid() const { return solid_; }
  /// Returns the load on all nodes [slots, N].
  Field load(const Lattice& lattice) const {
    Field out(lattice.nodes.size(), Vector3d::Zero());
    for (const auto& [cell, load_n] : loads_) {
      for (int c = 0; c < 8; ++c) {
        const Vector3i node = cell + Vector3i(c & 1, c >> 1 & 1, c >> 2 & 1);
        out[static_cast<size_t>(lattice.slotAt(node))] += load_n[static_cast<size_t>(c)];
      }
    }
    return out;
  }
  /// Returns the displacement at a position, both in the wall's axes [m]; not finite outside the cells.
  /// @param u_m  [slots]
  Vector3d movedAt(const Lattice& lattice, const Field& u_m, const Vector3d& position_m) const {
    const Vector3d at = placing_.turn * position_m / spacing_m_ + placing_.shift - low_.cast<double>();
    const Vector3i cell = at.array().floor().cast<int>();
    if (solid_.label(cell.x(), cell.y(), cell.z()) == 0) return Vector3d::Constant(std::nan(""));
    Vector3d out = Vector3d::Zero();
    for (int c = 0; c < 8; ++c) {
      const Vector3i corner(c & 1, c >> 1 & 1, c >> 2 & 1);
      out += weightOf(c, at - cell.cast<double>()) * u_m[static_cast<size_t>(lattice.slotAt(cell + corner))];
    }
    return placing_.turn.transpose() * out;
  }

 private:
  /// Returns the weight of a corner at a position in its cell.
  static double weightOf(int corner, const Vector3d& in_cell) {
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= (corner >> axis & 1) ? in_cell[axis] : 1 - in_cell[axis];
    return weight;
  }
  /// Converts a position in spacings from the corner of the cell to the wall's own axes [m].
  Vector3d own(const Vector3i& cell, const Vector3d& in_cell) const {
    return placing_.turn.transpose() * ((cell + low_).cast<double>() + in_cell - placing_.shift) * spacing_m_;
  }
  void fillCell(const Vector3i& cell) {
    FilledCell found = sampled(cell, kSamples);
    if (found.inside > 0 && found.inside < 1) found = sampled(cell, kFineSamples);
    if (found.inside < kLeastShare) return;
    const size_t index = solid_.index(cell.x(), cell.y(), cell.z());
    solid_.labels[index] = 1;
    loads_.emplace_back(cell, found.load_n);
    if (found.inside < 1) solid_.partial.push_back({index, found.fill});
  }
  /// Samples a cell. @param samples  number per edge
  FilledCell sampled(const Vector3i& cell, int samples) const {
    FilledCell out;
    out.load_n.fill(Vector3d::Zero());
    out.fill.share = 0;
    out.fill.second.setZero();
    const int all = samples * samples * samples;
    const double share = 1.0 / all;
    int inside = 0;
    for (int s = 0; s < all; ++s) {
      const Vector3d at = (Vector3d(s % samples, s / samples % samples, s / samples / samples).array() + 0.5) / samples;
      const Vector3d position = own(cell, at);
      if (!wall_.inside(position)) continue;
      const Vector3d p = at.array() - 0.5;
      ++inside;
      out.fill.share += share;
      out.fill.first += share * p;
      out.fill.second += share * p * p.transpose();
      out.fill.second.diagonal().array() += share / (12.0 * samples * samples);
      const Vector3d force = share * std::pow(spacing_m_, 3) * (placing_.turn * wall_.load_n_per_m3(position));
      for (int c = 0; c < 8; ++c) out.load_n[static_cast<size_t>(c)] += weightOf(c, at) * force;
    }
    out.inside = static_cast<double>(inside) / all;
    return out;
  }

  const Wall& wall_;
  const Placing& placing_;
  double spacing_m_;
  Vector3i low_ = Vector3i::Zero();
  Solid solid_;
  std::vector<std::pair<Vector3i, std::array<Vector3d, 8>>> loads_;
};

Model modelOf(const Solid& solid, double poisson_ratio) {
  Body body;
  body.name = "wall";
  body.material = unitMaterial();
  body.material.young_modulus_pa = 1;
  body.material.poisson_ratio = poisson_ratio;
  body.material.law = Law::kNeoHookean;
  body.lattice = buildLattice(solid, body.material.weights);
  Model model;
  model.bodies.push_back(std::move(body));
  return model;
}

/// Removes the net force and torque that rounding and the staircase boundary leave in a load.
void balance(const ReferenceLattice& lattice, Field& load_n) {
  const auto rows = static_cast<Eigen::Index>(3 * lattice.active.size());
  Eigen::MatrixXd rigid = Eigen::MatrixXd::Zero(rows, 6);
  Eigen::VectorXd flat(rows);
  Vector3d middle = Vector3d::Zero();
  for (uint32_t slot : lattice.active)
    middle += lattice.restPosition(slot) / static_cast<double>(lattice.active.size());
  for (size_t i = 0; i < lattice.active.size(); ++i) {
    const Vector3d arm = lattice.restPosition(lattice.active[i]) - middle;
    for (int axis = 0; axis < 3; ++axis) {
      rigid.block<3, 1>(static_cast<Eigen::Index>(3 * i), axis) = Vector3d::Unit(axis);
      rigid.block<3, 1>(static_cast<Eigen::Index>(3 * i), 3 + axis) = Vector3d::Unit(axis).cross(arm);
    }
    flat.segment<3>(static_cast<Eigen::Index>(3 * i)) = load_n[lattice.active[i]];
  }
  const Eigen::VectorXd net = rigid.householderQr().solve(flat);
  flat -= rigid * net;
  for (size_t i = 0; i < lattice.active.size(); ++i) {
    load_n[lattice.active[i]] = flat.segment<3>(static_cast<Eigen::Index>(3 * i));
  }
}

/// Returns six prescribed displacements that remove all rigid motions and have no reaction under a balanced load: three
/// at one node, two at the node farthest from it, one at the node farthest from the line through both.
std::vector<PrescribedDof> pins(const ReferenceLattice& lattice) {
  const uint32_t a = lattice.active.front();
  const Vector3d at = lattice.restPosition(a);
  uint32_t b = a, c = a;
  for (uint32_t slot : lattice.active) {
    if ((lattice.restPosition(slot) - at).norm() > (lattice.restPosition(b) - at).norm()) b = slot;
  }
  const Vector3d line = lattice.restPosition(b) - at;
  const auto lever = [&](uint32_t slot) -> Vector3d { return line.cross(lattice.restPosition(slot) - at); };
  for (uint32_t slot : lattice.active) {
    if (lever(slot).norm() > lever(c).norm()) c = slot;
  }
  Eigen::Index along = 0, across = 0;
  line.cwiseAbs().maxCoeff(&along);
  lever(c).cwiseAbs().maxCoeff(&across);
  std::vector<PrescribedDof> out = {{c, static_cast<int>(across), 0}};
  for (int axis = 0; axis < 3; ++axis) {
    out.push_back({a, axis, 0});
    if (axis != along) out.push_back({b, axis, 0});
  }
  return out;
}

double work(const Field& force_n, const Field& u_m) {
  double sum = 0;
  for (size_t i = 0; i < u_m.size(); ++i) sum += force_n[i].dot(u_m[i]);
  return sum;
}

}  // namespace

Eigen::Matrix3d turned() {
  const auto about = [](double degrees, const Vector3d& axis) {
    return Eigen::AngleAxisd(degrees * M_PI / 180, axis).toRotationMatrix();
  };
  return about(17, Vector3d::UnitX()) * about(24, Vector3d::UnitY()) * about(30, Vector3d::UnitZ());
}

BentWall bendWall(const Wall& wall, const Placing& placing, double spacing_m, double poisson_ratio,
                  const std::vector<Backend>& backends, const std::vector<Vector3d>& watched_m) {
  const Grid grid(wall, placing, spacing_m);
  const Model model = modelOf(grid.solid(), poisson_ratio);
  const ReferenceSolver solver(model, Vector3d::Zero(), 1);
  Field load = grid.load(model.bodies[0].lattice);
  balance(solver, load);
  BentWall out;
  out.nodes = model.activeNodes();
  Field u;
  try {
    u = solveLinear(solver, pins(solver), load);
  } catch (const ConvergenceError&) {
    return out;  // it has hinges: a mechanism
  }
  out.excess = work(load, u) / wall.true_j(poisson_ratio) - 1;
  for (const Vector3d& position_m : watched_m)
    out.moved_m.push_back(grid.movedAt(model.bodies[0].lattice, u, position_m));
  const double scale = kSmall * spacing_m / largestNorm(u);
  for (Vector3d& at : u) at *= scale;
  for (Backend backend : backends) {
    out.on.push_back(-work(forcesOn(backend, model, u), u) / (work(load, u) * scale) - 1);
  }
  return out;
}

}  // namespace viscera::bench
