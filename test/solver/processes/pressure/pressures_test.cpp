// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Pressure in tubes and balls, against the formulas of thick walls (docs/physics.md 18).
#include "solver/processes/pressure/pressures.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "math/archive.h"
#include "math/number_text.h"
#include "model/shape/mesh/plain_meshes.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/pressure/pipe.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

using test::cutAcross;
using test::downAt;
using test::kHeldEnds;
using test::kInner_m;
using test::kOuter_m;
using test::kStill;
using test::kWall_m;
using test::pipe;
using test::pressureFact;
using test::pressuresOf;

constexpr double kPressure_pa = 13000;
constexpr double kAsThickTube = 0.05;   // of the growth of the diameter: the wanted accuracy at cells of 1 mm
constexpr double kClosed = 1e-5;        // of the forces' sizes: rounding in float32
constexpr double kOfPoiseuille = 0.05;  // of the flow: the wanted accuracy
constexpr double kMostResidual = 0.03;  // of a pressure: what stays below a clip or behind a cut
/// Returns the mean distance from the axis of the lumen's vertices in the middle of the pipe.
double lumenRadius_m(const Pressures& pressures, const Cavities& cavities) {
  double sum_m = 0;
  int count = 0;
  for (uint32_t v = 0; v < cavities.positions_m.size(); ++v) {
    if (std::abs(cavities.positions_m[v].x()) > 0.004) continue;
    const Vector3d at = pressures.loads().position_m(v);
    sum_m += std::hypot(at.y(), at.z());
    ++count;
  }
  return sum_m / count;
}

/// Radius at which a stretch is measured, near that of the lumen, and the stretch.
struct LumenStretch {
  double at_m, stretch;
};
/// Returns the stretch of the lumen's radius after some ticks.
LumenStretch lumenStretch(const Scene& scene, int ticks) {
  const Model model = buildModel(scene);
  const Cavities cavities = cavitiesOf(model.bodies[0], scene.bodies[0]);
  CpuSolver solver(model, scene);
  const double before_m = lumenRadius_m(pressuresOf(solver), cavities);
  for (int t = 0; t < ticks; ++t) solver.step(ToolMotions{});
  return {before_m, lumenRadius_m(pressuresOf(solver), cavities) / before_m};
}

/// Returns the stretch at a pressure that grows with it. @param most  largest stretch
template <class Pressure>
double stretchAt(double wanted_pa, const Pressure& pressure_pa, double most) {
  double low = 1, high = most;
  while (high - low > 1e-6) (pressure_pa(0.5 * (low + high)) < wanted_pa ? low : high) = 0.5 * (low + high);
  return low;
}

/// Lame: a long tube with held ends.
TEST(Pressure, WidensAPipeAsLamesThickTube) {
  constexpr double kE_pa = 3e6, kNu = 0.3;
  const LumenStretch got = lumenStretch(
      pipe("young_modulus_pa: 3.0e+6, poisson_ratio: 0.3, density_kg_per_m3: 1.0e+5, mass_damping_per_s: 100",
           kPressure_pa, kHeldEnds),
      16);
  const double a2 = kInner_m * kInner_m, b2 = kOuter_m * kOuter_m;
  const double exact = (1 + kNu) / kE_pa * kPressure_pa * a2 / (b2 - a2) * (1 - 2 * kNu + b2 / (got.at_m * got.at_m));
  EXPECT_NEAR((got.stretch - 1) / exact, 1, kAsThickTube);
  RecordProperty("over_exact", exactText((got.stretch - 1) / exact));
}

/// An incompressible neo-Hookean tube with held ends: p = mu times the integral of (1 - lambda^-4) / R over the wall.
TEST(Pressure, WidensASoftPipeAsTheNeoHookeanTube) {
  constexpr double kSoft_pa = 6500;  // mu times the logarithm of the ratio of radii is the most that it bears
  constexpr double kE_pa = 1.2e5, kNu = 0.49, kMu_pa = kE_pa / (2 * (1 + kNu));
  const LumenStretch got =
      lumenStretch(pipe("young_modulus_pa: 1.2e+5, poisson_ratio: 0.49, density_kg_per_m3: 2.0e+4, "
                        "mass_damping_per_s: 100",
                        kSoft_pa, kHeldEnds),
                   24);
  const auto pressure_pa = [&](double stretch) {
    constexpr int kPieces = 1000;
    const double k = (stretch * stretch - 1) * kInner_m * kInner_m, step = kWall_m / kPieces;
    double sum = 0;
    for (int i = 0; i < kPieces; ++i) {
      const double r = kInner_m + (i + 0.5) * step, lambda2 = 1 + k / (r * r);
      sum += (1 - 1 / (lambda2 * lambda2)) / r * step;
    }
    return kMu_pa * sum;
  };
  const double at_face = stretchAt(kSoft_pa, pressure_pa, 3);
  const double exact = std::sqrt(1 + (at_face * at_face - 1) * std::pow(kInner_m / got.at_m, 2));
  EXPECT_GT(exact, 1.15);
  EXPECT_NEAR((got.stretch - 1) / (exact - 1), 1, kAsThickTube);
  RecordProperty("over_exact", exactText((got.stretch - 1) / (exact - 1)));
}

TEST(Pressure, ForcesOfAClosedCavitySumToZero) {
  const Scene scene = pipe("young_modulus_pa: 1.0e+6, density_kg_per_m3: 1.0e+5", kPressure_pa,
                           "fixed: [{shape: plane, point_m: [-0.012, 0, 0], normal: [1, 0, 0]}]");
  const Model model = buildModel(scene);
  CpuSolver solver(model, scene);
  for (int t = 0; t < 3; ++t) solver.step(ToolMotions{});
  const SurfaceLoads& loads = pressuresOf(solver).loads();
  Vector3d sum = Vector3d::Zero();
  double sizes_n = 0;
  for (size_t i = 0; i < loads.slots().size(); ++i) {
    sum += loads.force_n(i);
    sizes_n += loads.force_n(i).norm();
  }
  EXPECT_GT(sizes_n, 0.1);
  EXPECT_LT(sum.norm(), kClosed * sizes_n);
}

/// A ball's shell: the pressure of a thick incompressible neo-Hookean shell is mu (2/x + 1/(2 x^4)) at the stretch of
/// its outer face less the same at that of its inner face. It gives way at a stretch of 1.4, above this pressure.
TEST(Pressure, BlowsABalloonUpAsTheNeoHookeanShell) {
  constexpr double kOut_m = 0.02, kIn_m = 0.017, kE_pa = 20000, kNu = 0.49, kPressed_pa = 1000;
  constexpr double kMu_pa = kE_pa / (2 * (1 + kNu));
  const test::TemporaryFolder folder;
  std::string obj;
  uint32_t first = 1;
  for (const double radius_m : {kOut_m, kIn_m}) {
    const TriangleMesh ball = ballMesh(radius_m, 0.002);
    for (const Vector3f& p : ball.positions_m)
      obj += "v " + exactText(p.x()) + " " + exactText(p.y()) + " " + exactText(p.z()) + "\n";
    for (const auto& t : ball.triangles) {
      const bool outer = radius_m == kOut_m;
      obj += "f " + std::to_string(first + t[0]) + " " + std::to_string(first + t[outer ? 1 : 2]) + " " +
             std::to_string(first + t[outer ? 2 : 1]) + "\n";
    }
    first += static_cast<uint32_t>(ball.positions_m.size());
  }
  folder.write("balloon.obj", obj);
  const auto pressure_pa = [&](double inner) {
    const double outer = std::cbrt(1 + (std::pow(inner, 3) - 1) * std::pow(kIn_m / kOut_m, 3));
    const auto bears = [](double x) { return 2 / x + 0.5 * std::pow(x, -4); };
    return kMu_pa * (bears(outer) - bears(inner));
  };
  const double exact = stretchAt(kPressed_pa, pressure_pa, 1.35);
  EXPECT_GT(exact, 1.15);
  Scene scene = parseScene(
      "bodies: [{name: balloon, source: mesh, mesh_file: balloon.obj, spacing_m: 0.003, pressure: {mean_pa: 1000}, "
      "material: {young_modulus_pa: 20000, poisson_ratio: 0.49, mass_damping_per_s: 80}}]\n" +
          std::string(kStill),
      folder.file("balloon.yaml"));
  scene.folder = folder.path();
  const Model model = buildModel(scene);
  CpuSolver solver(model, scene);
  const double before_ml = pressureFact(solver, "cavity_ml");
  for (int t = 0; t < 20; ++t) solver.step(ToolMotions{});
  const double over_exact = (std::cbrt(pressureFact(solver, "cavity_ml") / before_ml) - 1) / (exact - 1);
  EXPECT_NEAR(over_exact, 1, kAsThickTube);
  EXPECT_EQ(solver.health().trips, 0U);
  RecordProperty("over_exact", exactText(over_exact));
}

/// Poiseuille's flow through what is left of the lumen. The outer piece falls off, so that nothing covers the hole.
TEST(Pressure, BleedsAsPoiseuilleSays) {
  constexpr double kRadius_m = 0.0005, kLow_pa = 300, kCut_m = 0.0102, kStart_m = -0.02;
  constexpr double kViscosity_pa_s = 3.5e-3, kMlPerMin = 6e7;
  const Scene scene = parseScene(
      "bodies:\n  - {name: pipe, source: tube, spacing_m: 0.0005, tube: {radius_m: 0.001, wall_m: 0.0005, path: "
      "[{position_m: [-0.02, 0, 0]}, {position_m: [0.02, 0, 0]}]}, pressure: {mean_pa: 300}, material: "
      "{young_modulus_pa: 50000, density_kg_per_m3: 10000, mass_damping_per_s: 2, bleeding: {flow_ml_per_min: 10000}}, "
      "fixed: [{shape: plane, point_m: [-0.02, 0, 0], normal: [1, 0, 0]}]}\n"
      "styluses: [{name: left, idle: cut, cut: {blade_length_m: 0.03}}]\n"
      "environment: {gravity_m_per_s2: [2, 0, 0]}\nsolver: {backend: cpu, threads: 1, sleep_speed_m_per_s: 0}\n",
      "cut.yaml");
  const Model model = buildModel(scene);
  CpuSolver solver(model, scene);
  for (int t = 0; t < 13; ++t) solver.step(ToolMotions{});
  EXPECT_EQ(pressureFact(solver, "flow_ml_per_min"), 0);
  cutAcross(solver, kCut_m);
  for (int t = 0; t < 20; ++t) solver.step(ToolMotions{});
  const double exact =
      kMlPerMin * 3.14159265 * std::pow(kRadius_m, 4) * kLow_pa / (8 * kViscosity_pa_s * (kCut_m - kStart_m));
  EXPECT_NEAR(pressureFact(solver, "flow_ml_per_min") / exact, 1, kOfPoiseuille);
  RecordProperty("over_exact", exactText(pressureFact(solver, "flow_ml_per_min") / exact));
  EXPECT_LT(pressureFact(solver, "least_pressure_pa"), kMostResidual * kLow_pa);
  EXPECT_EQ(solver.health().trips, 0U);
}

/// A clip between the supply and the cut stops the flow, and the pressure beyond it falls.
TEST(Pressure, AClipStopsTheFlowToACut) {
  Scene scene = pipe(
      "young_modulus_pa: 1.0e+5, density_kg_per_m3: 1.0e+4, mass_damping_per_s: 30, bleeding: "
      "{flow_ml_per_min: 120}",
      3000, "fixed: [{shape: plane, point_m: [-0.012, 0, 0], normal: [1, 0, 0]}]");
  scene.styluses.resize(1);
  scene.styluses[0].idle = ToolMode::kClip;
  scene.styluses[0].cut.blade_length_m = 0.03;
  const Model model = buildModel(scene);
  CpuSolver solver(model, scene);
  for (int t = 0; t < 13; ++t) solver.step(ToolMotions{});
  const Vector3d at(0, 0, -0.006);
  StylusMotion clip = downAt(ToolMode::kClip, at, at);
  clip.opens_from_rad = clip.opens_to_rad = 0.5;
  solver.step(ToolMotions{clip});
  clip.opens_to_rad = 0;
  for (int t = 0; t < 20; ++t) solver.step(ToolMotions{clip});
  EXPECT_LT(pressureFact(solver, "narrowest"), 0.3);
  EXPECT_LT(pressureFact(solver, "least_pressure_pa"), kMostResidual * 3000);
  EXPECT_NEAR(pressureFact(solver, "pressure_pa"), 3000, 1);
  cutAcross(solver, 0.006);
  for (int t = 0; t < 20; ++t) solver.step(ToolMotions{});
  EXPECT_GT(pressureFact(solver, "open_m2"), 0);
  EXPECT_LT(pressureFact(solver, "flow_ml_per_min"), 1);
  EXPECT_NEAR(pressureFact(solver, "pressure_pa"), 3000, 1);
  EXPECT_EQ(solver.health().trips, 0U);
}

TEST(Pressure, GoesOnFromASavedState) {
  const Scene scene = pipe("young_modulus_pa: 1.0e+6, density_kg_per_m3: 1.0e+5", kPressure_pa, kHeldEnds);
  const Model model = buildModel(scene);
  CpuSolver solver(model, scene);
  for (int t = 0; t < 5; ++t) solver.step(ToolMotions{});
  Archive saved;
  findProcess<Pressures>(solver)->persist(saved);
  Pressures other(scene, model);
  EXPECT_NE(hashWith(0, other), hashWith(0, pressuresOf(solver)));
  Archive read(saved.take());
  other.persist(read);
  EXPECT_EQ(hashWith(0, other), hashWith(0, pressuresOf(solver)));
}

/// Returns the error that a body makes.
std::string faultOf(const std::string& keys) {
  try {
    buildModel(parseScene("bodies: [{name: pipe, " + keys + "}]", "pipe.yaml"));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Pressure, SaysWhatIsWrong) {
  const std::string from =
      "source: tube, spacing_m: 0.001, tube: {radius_m: 0.003, wall_m: 0.0008, path: [{position_m: [-0.012, 0, 0]}, "
      "{position_m: [0.012, 0, 0]}]}, pressure: {mean_pa: 1000";
  EXPECT_EQ(faultOf(from + ", pulse_pa: 1000}"), "");
  const std::string pulse = faultOf(from + ", pulse_pa: 1001}");
  EXPECT_NE(pulse.find("body 'pipe': pressure.pulse_pa must be within 0 .. pressure.mean_pa, 1000 Pa; found 1001 Pa"),
            std::string::npos)
      << pulse;
  for (const char* const bile : {"material: {bleeding: {flow_ml_per_min: 1, fluid: bile}}",
                                 "parts: [{part: tube, bleeding: {flow_ml_per_min: 1, fluid: bile}}]"}) {
    const std::string fault = faultOf(from + "}, " + bile);
    EXPECT_NE(fault.find("needs bleeding.fluid blood"), std::string::npos) << fault;
  }
}

TEST(Tube, SaysWhatIsWrong) {
  const std::string from = "source: tube, spacing_m: 0.001, tube: {radius_m: 0.003, wall_m: 0.0008, path: ";
  const std::string ends = "[{position_m: [-0.012, 0, 0]}, {position_m: [0.012, 0, 0]}]";
  EXPECT_EQ(faultOf(from + ends + "}"), "");
  EXPECT_EQ(faultOf("source: tube, spacing_m: 0.001, tube: {radius_m: 0.003, wall_m: 0.003, path: " + ends + "}"),
            "body 'pipe': tube.wall_m must be less than its radius_m, 0.003 m; found 0.003 m");
  EXPECT_EQ(faultOf(from + "[{position_m: [0, 0, 0]}, {position_m: [0, 0, 0]}]}"),
            "body 'pipe': tube.path[1] repeats the point before it; points must be at least 1e-06 m apart");
  const std::string bent =
      faultOf(from + "[{position_m: [0, 0, 0]}, {position_m: [0.01, 0, 0]}, {position_m: [0, 0.001, 0]}]}");
  EXPECT_NE(bent.find("must be more than the radius of the tube, 0.003 m"), std::string::npos) << bent;
  const std::string coarse =
      faultOf("source: tube, spacing_m: 0.002, tube: {radius_m: 0.003, wall_m: 0.0008, path: " + ends + "}");
  EXPECT_NE(coarse.find("spacing_m must be at most 0.0016"), std::string::npos) << coarse;
  const std::string apart = faultOf(from + ends +
                                    ", branches: [{name: side, path: [{position_m: [0, 0.01, 0]}, "
                                    "{position_m: [0, 0.02, 0]}]}]}");
  EXPECT_NE(apart.find("tube.branches[0].path[0] must lie in the lumen"), std::string::npos) << apart;
}

/// The lumens of a tube and its branch are one: one closed border with three open ends.
TEST(Tube, JoinsTheLumensOfBranches) {
  const Scene scene = parseScene(
      "bodies: [{name: fork, source: tube, spacing_m: 0.001, pressure: {mean_pa: 1000}, tube: {radius_m: 0.003, "
      "wall_m: "
      "0.0008, path: [{position_m: [-0.012, 0, 0]}, {position_m: [0.012, 0, 0]}], branches: [{name: side, radius_m: "
      "0.0025, path: [{position_m: [0, 0, 0]}, {position_m: [0, 0.012, 0]}]}]}, parts: [{part: side}]}]",
      "fork.yaml");
  const Model model = buildModel(scene);
  const Cavities cavities = cavitiesOf(model.bodies[0], scene.bodies[0]);
  EXPECT_EQ(cavities.rims.size(), 3U);
  EXPECT_EQ(cavities.lumen.links.size() + 1, cavities.lumen.stations.size());
  Vector3d sum = Vector3d::Zero();
  double area_m2 = 0;
  const auto at = [&](uint32_t v) {
    if (v < cavities.positions_m.size()) return cavities.positions_m[v];
    Vector3d centre = Vector3d::Zero();
    const auto& rim = cavities.rims[v - cavities.positions_m.size()];
    for (const uint32_t on : rim) centre += cavities.positions_m[on] / static_cast<double>(rim.size());
    return centre;
  };
  for (const auto& t : cavities.triangles) {
    const Vector3d area = 0.5 * (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
    sum += area;
    area_m2 += area.norm();
  }
  EXPECT_LT(sum.norm(), kClosed * area_m2);
}

}  // namespace
}  // namespace viscera
