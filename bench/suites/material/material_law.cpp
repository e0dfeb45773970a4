// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The neo-Hookean law compared with an independent finite element program: a clamped block in tension, compression and
// shear, and a sphere pressed into a block.
#include <algorithm>
#include <array>
#include <cmath>

#include "bench/harness/specimens/block.h"
#include "bench/suites/material/material_parts.h"
#include "math/number_text.h"
#include "solver/reference/statics.h"

namespace viscera::bench {

namespace {

// CalculiX 2.20, C3D10, neo-Hooke: a block of 24 x 24 x 36 mm, E 20 kPa, ends clamped, the upper one displaced by these
// shares of the height. Forces have two decimals.
constexpr std::array<double, 4> kShares = {0.1, 0.2, 0.35, 0.5};
struct ClampedBlock {
  const char* name;
  int axis;  ///< axis along which the upper end moves
  double sign;
  int reads;  ///< axis of the force
  double nu;
  std::array<double, 4> force_n;  ///< 0: CalculiX had stopped before
  double least, most;             ///< accepted ratio to CalculiX's force, up to 35 %
};
// Between the plates, the force of a sheared block is a tenth of its resistance, so the spatial error is larger.
constexpr double kLeast = 0.97, kMost = 1.04, kLeastBetween = 0.93, kMostBetween = 1.07;
constexpr ClampedBlock kBlocks[] = {
    {"pulled", 2, 1, 2, 0.3, {1.09, 2.01, 3.14, 4.07}, kLeast, kMost},
    {"squeezed", 2, -1, 2, 0.3, {1.34, 3.02, 6.50, 0}, kLeast, kMost},
    {"sheared", 0, 1, 0, 0.3, {0.229, 0.462, 0.830, 1.23}, kLeast, kMost},
    {"sheared, between the plates", 0, 1, 2, 0.3, {0.022, 0.088, 0.26, 0.50}, kLeastBetween, kMostBetween},
    {"pulled", 2, 1, 2, 0.45, {1.17, 2.14, 3.34, 4.34}, kLeast, kMost},
    {"squeezed", 2, -1, 2, 0.45, {1.44, 3.29, 7.12, 0}, kLeast, kMost},
    {"pulled", 2, 1, 2, 0.49, {1.20, 2.21, 3.46, 4.51}, kLeast, kMost},
    {"squeezed", 2, -1, 2, 0.49, {1.49, 3.41, 7.69, 13.8}, kLeast, kMost}};
constexpr double kYoung_pa = 20e3, kDensity_kg_per_m3 = 1060, kLawSpacing_m = 0.003;
constexpr int kBlockWide = 8, kBlockHigh = 12;  ///< number of cells of 3 mm
constexpr double kLoadStep = 0.05;              ///< relative to the height, between equilibria
constexpr double kLargestShare = 0.36;          ///< largest share at which forces are checked

MaterialConfig lawMaterial(double nu) {
  MaterialConfig material;
  material.young_modulus_pa = kYoung_pa;
  material.poisson_ratio = nu;
  material.density_kg_per_m3 = kDensity_kg_per_m3;
  material.mass_damping_per_s = material.stiffness_damping_ratio = 0;
  material.law = Law::kNeoHookean;
  return material;
}

/// Returns the forces of a clamped block with its upper end displaced by kShares of the height [N].
std::array<double, 4> forcesOf(const ClampedBlock& block, Backend backend) {
  const Model model = blockModel({kBlockWide, kBlockWide, kBlockHigh}, kLawSpacing_m, lawMaterial(block.nu),
                                 [](const Vector3i& n) { return n.z() == 0; });
  const Lattice& lattice = model.bodies[0].lattice;
  ReferenceSolver solver(model, Vector3d::Zero(), 1);
  std::array<double, 4> out{};
  double share = 0;
  for (size_t i = 0; i < kShares.size(); ++i) {
    while (share < kShares[i] - 1e-9) {
      share = std::min(kShares[i], share + kLoadStep);
      std::vector<PrescribedDof> moved;
      for (const uint32_t slot : lattice.active_slots) {
        if (lattice.nodeAt(slot).z() != kBlockHigh) continue;
        for (int axis = 0; axis < 3; ++axis)
          moved.push_back({slot, axis, axis == block.axis ? block.sign * share * kBlockHigh * kLawSpacing_m : 0});
      }
      StaticsOptions options;
      options.tolerance = 1e-6;  // forces are compared to a thousandth
      solveStatics(solver, moved, {}, options);
    }
    const Field force_n = forcesOn(backend, model, solver.u_m);
    for (const uint32_t slot : lattice.active_slots) {
      if (lattice.nodeAt(slot).z() == kBlockHigh) out[i] += std::abs(block.sign) * force_n[slot][block.reads];
    }
    out[i] = std::abs(out[i]);
  }
  return out;
}

void measureBlocks(Report& report, Backend backend) {
  Table table(
      "A clamped block of 24 x 24 x 36 mm at 3 mm, neo_hookean, forces of " + nameOf(backend) + " over CalculiX's, %",
      {{"moved"}, {"nu"}, {"10 %", "%"}, {"20 %", "%"}, {"35 %", "%"}, {"50 %", "%"}});
  for (const ClampedBlock& block : kBlocks) {
    if (report.isShort() && block.nu != 0.3) continue;
    const std::array<double, 4> found = forcesOf(block, backend);
    std::vector<Cell> row = {block.name, block.nu};
    double least = 1e9, most = 0;
    for (size_t i = 0; i < kShares.size(); ++i) {
      const double share = block.force_n[i] > 0 ? found[i] / block.force_n[i] : 0;
      if (share > 0)
        row.emplace_back(100 * share);
      else
        row.emplace_back("");
      if (share == 0 || kShares[i] > kLargestShare) continue;
      least = std::min(least, share);
      most = std::max(most, share);
    }
    table.add(row);
    const std::string what =
        std::string("law: block ") + block.name + ", nu " + numberText(block.nu, 2) + ", " + nameOf(backend);
    report.checkAtLeast(what + ": least force to 35 % over CalculiX's", least, block.least);
    report.checkAtMost(what + ": largest", most, block.most);
  }
  report.add(table, "law_blocks_" + nameOf(backend));
}

// A block of 60 x 60 x 30 mm on a plate, with a sphere of 15 mm pressed into its centre, without friction.
constexpr double kBall_m = 0.015;
constexpr int kBallWide = 20, kBallHigh = 10;
struct Pressed {
  double nu, depth_m, force_n;
};
constexpr Pressed kPressed[] = {
    {0.3, 1.0e-3, 0.13}, {0.3, 2.1e-3, 0.414}, {0.3, 3.45e-3, 0.930}, {0.3, 6e-3, 2.33}, {0.45, 6e-3, 2.47}};
constexpr double kLeastPressed = 0.95, kMostPressed = 1.03;

/// Returns the static force on a probe that was pressed in [N].
double pressedForce(const Pressed& press, Backend backend) {
  constexpr int kTickSubsteps = 10;
  MaterialConfig material = lawMaterial(press.nu);
  // Shear of the height, the slowest motion, is critically damped; the probe takes two of its periods.
  const double c_s = std::sqrt(kYoung_pa / (2 * (1 + press.nu)) / kDensity_kg_per_m3);
  const double period_s = 4 * kBallHigh * kLawSpacing_m / c_s;
  material.mass_damping_per_s = 4 * M_PI / period_s;
  const Model model = blockModel({kBallWide, kBallWide, kBallHigh}, kLawSpacing_m, material,
                                 [](const Vector3i& n) { return n.z() == 0; });
  Scene scene = plainScene(model, kTickSubsteps);
  StylusConfig stylus;
  stylus.probe.radius_m = kBall_m;
  scene.styluses = {stylus};
  const std::unique_ptr<TissueStepper> solver = solverOn(backend, model, scene);
  const Vector3d top = kLawSpacing_m * Vector3d(kBallWide / 2.0, kBallWide / 2.0, kBallHigh) + Vector3d(0, 0, kBall_m);
  const double tick_s = kTickSubsteps * solver->dt_s();
  const int sinking = static_cast<int>(2 * period_s / tick_s);
  for (int tick = 0; tick < 4 * sinking; ++tick) {
    ToolMotions motions{};
    motions[0].mode = ToolMode::kProbe;
    motions[0].present = true;
    const auto at = [&](double share) { return Vector3d(top - Vector3d(0, 0, std::min(1.0, share) * press.depth_m)); };
    motions[0].from.position_m = at(static_cast<double>(tick) / sinking);
    motions[0].to.position_m = at((tick + 1.0) / sinking);
    solver->step(motions);
  }
  const ReferenceLattice lattice(model);
  const HostState state = solver->readState();
  Field u(model.slots(), Vector3d::Zero());
  for (const uint32_t slot : lattice.active) u[slot] = xyz(state.displacement_m[slot]);
  double sum = 0;
  for (const uint32_t slot : lattice.active) {
    if (isFixed(lattice.nodes[slot])) sum -= lattice.elasticForce(u, slot).z();
  }
  return sum;
}

void measurePressed(Report& report, Backend backend) {
  Table table("A sphere of 15 mm pressed into a block of 60 x 60 x 30 mm at 3 mm, neo_hookean, " + nameOf(backend),
              {{"nu"}, {"depth", "mm"}, {"force", "N"}, {"CalculiX", "N"}, {"share", "%"}});
  for (const Pressed& press : kPressed) {
    const double found = pressedForce(press, backend), share = found / press.force_n;
    table.add({press.nu, 1e3 * press.depth_m, found, press.force_n, 100 * share});
    const std::string what = "law: sphere " + numberText(1e3 * press.depth_m, 3) + " mm deep, nu " +
                             numberText(press.nu, 2) + ", " + nameOf(backend);
    report.checkAtLeast(what + ": force over CalculiX's", share, kLeastPressed);
    report.checkAtMost(what + ": the same", share, kMostPressed);
  }
  report.add(table, "law_pressed_" + nameOf(backend));
}

}  // namespace

void measureLaw(Report& report) {
  report.stage("law compared with finite elements");
  for (const Backend backend : report.backends()) {
    measureBlocks(report, backend);
    measurePressed(report, backend);
  }
}

}  // namespace viscera::bench
