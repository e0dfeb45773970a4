// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/mapping_error.h"
#include "bench/harness/specimens/block.h"
#include "bench/suites/egve/egve_parts.h"
#include "solver/reference/statics.h"

namespace viscera::bench {

namespace {

// The spacing of the fine lattice is the unit of length: a bar along x, twice as long as it is wide.
constexpr double kBent = 0.8, kTwisted = 1.0;  // rotation of one end against the other [rad]
constexpr double kIndented = 1.0 / 8;          // relative to the width
constexpr double kPatch = 0.3;                 // radius of the pushed patch, relative to the width
constexpr int kLoadSteps = 4;
constexpr int kFiner = 4;  // refinement of the reference over the lattice that is measured

/// A bar of neo-Hookean cells in equilibrium, in float64: the reference for lattices with a subset of its nodes.
class FineBar {
 public:
  explicit FineBar(int width) : width_(width), model_(modelOf(width)), solver_(model_, Vector3d::Zero(), 1) {}

  /// Solves with fixed nodes. @param placed  returns the position of a fixed node
  template <class IsHeld, class Placed>
  void hold(IsHeld isHeld, Placed placed) {
    std::fill(solver_.u_m.begin(), solver_.u_m.end(), Vector3d::Zero());
    std::vector<PrescribedDof> held;
    for (const uint32_t slot : solver_.active) {
      const Vector3d rest = solver_.restPosition(slot);
      if (!isHeld(rest)) continue;
      const Vector3d u = placed(rest) - rest;
      for (int axis = 0; axis < 3; ++axis) held.push_back({slot, axis, u[axis]});
    }
    StaticsOptions options;
    options.load_steps = kLoadSteps;
    options.tolerance = 1e-8;
    solveStatics(solver_, held, {}, options);
  }
  void bend() {
    const double length = 2.0 * width_, radius = length / kBent;
    hold([&](const Vector3d& x) { return x.x() < 0.5 || x.x() > length - 0.5; },
         [&](const Vector3d& x) {
           const double angle = kBent * x.x() / length, r = radius - (x.z() - 0.5 * width_);
           return Vector3d(r * std::sin(angle), x.y(), 0.5 * width_ + radius - r * std::cos(angle));
         });
  }
  void twist() {
    const double length = 2.0 * width_;
    const Vector3d middle(0, 0.5 * width_, 0.5 * width_);
    hold([&](const Vector3d& x) { return x.x() < 0.5 || x.x() > length - 0.5; },
         [&](const Vector3d& x) {
           const Eigen::AngleAxisd turn(kTwisted * x.x() / length, Vector3d::UnitX());
           return Vector3d(turn * (x - middle) + middle);
         });
  }
  void indent() {
    const Vector3d top(width_, 0.5 * width_, width_);
    hold([&](const Vector3d& x) { return x.z() < 0.5 || (x.z() > width_ - 0.5 && (x - top).norm() < kPatch * width_); },
         [&](const Vector3d& x) {
           if (x.z() < 0.5) return x;
           const double r = (x - top).norm() / (kPatch * width_);
           return Vector3d(x - kIndented * width_ * (1 - 0.5 * r * r) * Vector3d::UnitZ());
         });
  }
  /// Returns the deformed position, interpolated within the cells.
  Vector3d operator()(const Vector3d& x) const {
    const Vector3i most = model_.bodies[0].lattice.nodes_per_axis - Vector3i::Constant(2);
    const Vector3i cell = x.array().floor().cast<int>().max(0).min(most.array());
    const Vector3d p = x - cell.cast<double>();
    Vector3d out = x;
    for (int c = 0; c < 8; ++c) {
      const Vector3i corner(c & 1, c >> 1 & 1, c >> 2);
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) weight *= corner[axis] ? p[axis] : 1 - p[axis];
      out += weight * solver_.u_m[static_cast<size_t>(model_.bodies[0].lattice.slotAt(cell + corner))];
    }
    return out;
  }

 private:
  static Model modelOf(int width) {
    MaterialConfig material = unitMaterial();
    material.law = Law::kNeoHookean;
    return blockModel({2 * width, width, width}, 1, material);
  }
  int width_;
  Model model_;
  ReferenceSolver solver_;
};

/// Returns the bar's surface with grooves of up to a twelfth of its width, all inside the bar.
TriangleMesh groovedBar(int width, int around, int up) {
  const Vector3d half(width, 0.5 * width, 0.5 * width);
  return closedMesh(around, up, [&](const Vector3d& d) {
    const Vector3d on_cube = d / d.cwiseAbs().maxCoeff();
    const double groove = 1 + std::sin(9 * on_cube.x()) * std::cos(5 * on_cube.y() + 1) * std::cos(4 * on_cube.z());
    return Vector3d(half + (1 - groove / 12) * half.cwiseProduct(on_cube));
  });
}

Solid coarseBar(int width, int across) {
  Solid solid;
  solid.spacing_m = static_cast<double>(width) / across;
  solid.cells = {2 * across, across, across};
  solid.labels.assign(static_cast<size_t>(solid.cells.prod()), 1);
  solid.part_names = {"bar"};
  return solid;
}

}  // namespace

void measureFinerErrors(Report& report) {
  std::vector<Column> columns = {
      {"deformation"}, {"cells across", "", 3}, {"mapping"}, {"vertices that have it", "%", 3}};
  for (const Column& column : errorColumns()) columns.push_back(column);
  Table table(
      "error of the mapping, nodes where those of a lattice four times finer are at rest under load (float64): a bar "
      "with grooves",
      columns);
  using Load = void (FineBar::*)();
  const std::pair<const char*, Load> loads[] = {
      {"bending", &FineBar::bend}, {"twist", &FineBar::twist}, {"indentation", &FineBar::indent}};
  for (const int across : report.isShort() ? std::vector<int>{2} : std::vector<int>{2, 3}) {
    const int width = kFiner * across;
    const TriangleMesh mesh = groovedBar(width, report.isShort() ? 48 : 120, report.isShort() ? 32 : 120);
    FineBar truth(width);
    for (const auto& [name, load] : loads) {
      report.stage("equilibrium of " + std::to_string(width) + " cells across, " + name);
      (truth.*load)();
      for (const Mapping mapping : allMappings()) {
        const Model model = mappedModel(coarseBar(width, across), mesh, mapping);
        std::vector<Cell> row = {name, across, nameOf(mapping), 100 * shareAsAsked(model)};
        appendError(mappingError(model, [&](const Vector3d& x) { return truth(x); }), row);
        table.add(row);
      }
    }
  }
  report.add(table, "finer");
}

}  // namespace viscera::bench
