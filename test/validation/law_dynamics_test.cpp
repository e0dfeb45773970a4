// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Oscillation of tissue of the neo-Hookean law, and its return to rest under pressing objects (physics.md 2).
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>
#include <complex>

#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kPi = 3.14159265358979323846;

struct Swing {
  double frequency_hz, decay_per_s;
};

/// Returns the damped oscillations of a signal that has `swings` of them plus a constant, by the matrix pencil method
/// (Hua and Sarkar 1990). @param interval_s  between its samples
std::vector<Swing> swingsOf(const std::vector<double>& signal, double interval_s, int swings) {
  const auto samples = static_cast<Eigen::Index>(signal.size()), pencil = samples / 3,
             rank = Eigen::Index{2} * swings + 1;
  Eigen::MatrixXd shifted(samples - pencil, pencil + 1);
  for (Eigen::Index r = 0; r < shifted.rows(); ++r)
    for (Eigen::Index c = 0; c < shifted.cols(); ++c) shifted(r, c) = signal[static_cast<size_t>(r + c)];
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(shifted, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::MatrixXd v = svd.matrixV().leftCols(rank);
  const Eigen::MatrixXd step = v.topRows(pencil).colPivHouseholderQr().solve(v.bottomRows(pencil));
  std::vector<Swing> out;
  const Eigen::VectorXcd poles = Eigen::EigenSolver<Eigen::MatrixXd>(step, false).eigenvalues();
  for (const std::complex<double>& pole : poles) {
    const std::complex<double> rate = std::log(pole) / interval_s;
    if (rate.imag() > 0) out.push_back({rate.imag() / (2 * kPi), -rate.real()});
  }
  return out;
}

Swing nearest(const std::vector<Swing>& swings, double frequency_hz) {
  Swing out{};
  for (const Swing& swing : swings) {
    if (std::abs(swing.frequency_hz - frequency_hz) < std::abs(out.frequency_hz - frequency_hz)) out = swing;
  }
  return out;
}

/// Returns a block of 100 x 20 x 14 mm, fixed at one end.
Scene cantilever() {
  return parseScene(
      "bodies:\n"
      "  - {name: beam, source: box, box_size_m: [0.1, 0.02, 0.014], spacing_m: 0.004,\n"
      "     material: {young_modulus_pa: 20000, poisson_ratio: 0.3, density_kg_per_m3: 1060, mass_damping_per_s: 4},\n"
      "     fixed: [{shape: plane, point_m: [-0.05, 0, 0], normal: [1, 0, 0]}]}\n"
      "environment: {gravity_m_per_s2: [0, 0.02, 0.02]}\n"
      "solver: {tick_hz: 100, sleep_speed_m_per_s: 0}\n",
      "cantilever.yaml");
}

/// Returns a block on a plate, and a ball above its middle that moves down and stays. @param cells  in its radius
Scene pressedBlock(double cells) {
  Scene scene = parseScene(
      "bodies:\n"
      "  - {name: block, source: box, box_size_m: [0.048, 0.048, 0.03], spacing_m: 0.003,\n"
      "     fixed: [{shape: plane, point_m: [0, 0, -0.015], normal: [0, 0, 1]}]}\n"
      "styluses: [{name: left}]\n"
      "environment: {gravity_m_per_s2: [0, 0, 0]}\n"
      "solver: {sleep_speed_m_per_s: 0}\n",
      "pressed.yaml");
  scene.styluses[0].probe.radius_m = cells * 0.003;
  return scene;
}

}  // namespace

/// The frequencies are from CalculiX's *FREQUENCY with second-order tetrahedra. Drag reduces a velocity by gamma/2 per
/// second, the dashpot by tau omega^2/2, and both together lower the frequency.
TEST(LawDynamics, ACantileverSwingsAndDecaysAsItShould) {
  constexpr double kOff = 0.003;     // of a frequency
  constexpr double kOfDecay = 0.01;  // of a decay rate
  constexpr double kSeconds = 5;     // e^-10 of the oscillation is left
  constexpr double kWeak_hz[2] = {0.9767, 5.640}, kStrong_hz[2] = {1.3719, 7.401};
  const Scene scene = cantilever();
  const Model model = buildModel(scene);
  const auto solver = makeCpu(simdTargets().front(), model, scene, 1);
  std::vector<uint32_t> tip;
  for (const uint32_t slot : model.bodies[0].lattice.active_slots)
    if (restPosition(model.bodies[0], slot).x() > 0.0499) tip.push_back(slot);
  ASSERT_FALSE(tip.empty());
  std::vector<double> strong, weak;
  for (int t = 0; t < static_cast<int>(kSeconds * scene.solver.tick_hz); ++t) {
    solver->step({});
    const HostState state = solver->readState();
    double y = 0, z = 0;
    for (const uint32_t slot : tip) {
      y += static_cast<double>(state.displacement_m[slot].y);
      z += static_cast<double>(state.displacement_m[slot].z);
    }
    strong.push_back(y);
    weak.push_back(z);
  }
  const double tau_s = 0.2 * safeTimeStep(model);
  const auto expect = [&](const std::vector<double>& signal, const double(&frequencies_hz)[2]) {
    const std::vector<Swing> swings = swingsOf(signal, 1 / scene.solver.tick_hz, 4);
    for (const double undamped_hz : frequencies_hz) {
      const double omega = 2 * kPi * undamped_hz, decay = 2 + 0.5 * tau_s * omega * omega;
      const double damped_hz = std::sqrt(omega * omega - decay * decay) / (2 * kPi);
      const Swing swing = nearest(swings, damped_hz);
      EXPECT_NEAR(swing.frequency_hz / damped_hz, 1, kOff) << undamped_hz << " Hz";
      EXPECT_NEAR(swing.decay_per_s / decay, 1, kOfDecay) << undamped_hz << " Hz";
    }
  };
  expect(weak, kWeak_hz);
  expect(strong, kStrong_hz);
}

TEST(LawDynamics, NothingTremblesUnderBallsOfFewCells) {
  constexpr double kStill = 5e-3;  // of a cell, motion of a node in a tick: 15 um; the force varies by 1e-4 N
  struct Press {
    double radius, depth;  // [cells]
    double nu;
  };
  for (const Press& press : {Press{2, 1, 0.3}, Press{3, 2, 0.45}, Press{5, 1.5, 0.45}, Press{5, 3, 0.3}}) {
    Scene scene = pressedBlock(press.radius);
    scene.bodies[0].material.poisson_ratio = press.nu;
    const Model model = buildModel(scene);
    const auto solver = makeCpu(simdTargets().front(), model, scene, 2);
    constexpr double kTop_m = 0.015, kCell_m = 0.003;
    const double start_m = kTop_m + press.radius * kCell_m, end_m = start_m - press.depth * kCell_m;
    constexpr int kDown = 60, kHeld = 60;  // half of it settles; a tremble has a period of few ticks
    double before_m = start_m;
    double moved = 0;
    std::vector<layout::vec4> before;
    for (int t = 1; t <= kDown + kHeld; ++t) {
      const double share = std::min(1.0, static_cast<double>(t) / kDown), z = start_m + share * (end_m - start_m);
      solver->step(tool(ToolMode::kProbe, {0, 0, before_m}, {0, 0, z}));
      before_m = z;
      if (t < kDown + kHeld / 2) continue;
      const HostState now = solver->readState();
      for (size_t slot = 0; slot < before.size(); ++slot)
        moved = std::max(moved, (xyz(now.displacement_m[slot]) - xyz(before[slot])).norm() / kCell_m);
      before = now.displacement_m;
    }
    EXPECT_LT(moved, kStill) << "radius " << press.radius << ", depth " << press.depth << " cells, nu " << press.nu;
    EXPECT_EQ(solver->health().trips, 0U);
  }
}
