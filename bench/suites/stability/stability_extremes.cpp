// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "bench/harness/specimens/clamp.h"
#include "bench/suites/stability/stability_suite.h"
#include "bench/suites/stability/stability_trial.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/gpu/gpu_solver.h"
#include "viscera/math/state_hash.h"

namespace viscera::bench {

namespace {

constexpr double kSpacing_m = 0.005;
constexpr double kEnergyBound = 1.01;
constexpr double kRestChange = 1e-5;  // relative to the sag: not visible
constexpr double kUnitsSag_m = 1e-6;  // least sag of the box for a meaningful comparison
constexpr double kUnitsApart = 1e-6;  // relative to the largest displacement: float32 rounding of the scaled file

/// Returns a block with cells of two parts, alternating along x.
Model twoPartBlock(int cells, const PartConfig& first, const PartConfig& second) {
  Solid solid;
  solid.spacing_m = kSpacing_m;
  solid.cells = Vector3i::Constant(cells);
  solid.part_names = {first.part, second.part};
  for (int i = 0; i < solid.cells.prod(); ++i) solid.labels.push_back(static_cast<uint16_t>(1 + i % cells % 2));
  Body body;
  body.name = "block";
  body.parts = {first, second};
  body.lattice = buildLattice(solid, Weights::kCell);
  Model model;
  model.bodies.push_back(std::move(body));
  return model;
}

PartConfig part(const std::string& name, double young_modulus_pa, double density_kg_per_m3) {
  PartConfig out;
  out.part = name;
  out.young_modulus_pa = young_modulus_pa;
  out.density_kg_per_m3 = density_kg_per_m3;
  return out;
}

void ratios(Report& report) {
  struct Row {
    std::string name;
    PartConfig first, second;
  };
  const std::vector<Row> rows = {
      {"stiffness 1:1e6", part("a", 1e2, 1000), part("b", 1e8, 1000)},
      {"mass 1:1e4", part("a", 2e4, 1e1), part("b", 2e4, 1e5)},
      {"both, stiff is light", part("a", 1e2, 1e5), part("b", 1e8, 1e1)},
      {"both, stiff is heavy", part("a", 1e2, 1e1), part("b", 1e8, 1e5)},
  };
  Table table("two parts in one body, from random places", {{"backend"},
                                                            {"ratio"},
                                                            {"integrator"},
                                                            {"finite"},
                                                            {"max energy over start", "", 5},
                                                            {"energy left"},
                                                            {"stability monitor trips"},
                                                            {"ticks"}});
  for (Backend backend : report.backends()) {
    int not_finite = 0;
    double worst = 0;
    for (const Row& row : rows) {
      const Model model = twoPartBlock(report.isShort() ? 3 : 5, row.first, row.second);
      const std::vector<Start> starts = extremeStarts(model);
      for (Integrator integrator : {Integrator::kLeapfrog, Integrator::kPd}) {
        report.stage(row.name + ", " + nameOf(integrator) + ", " + nameOf(backend));
        const Scene scene = sceneAt(model, integrator, traitsOf(integrator).is_explicit ? 1 : 100);
        const Outcome outcome = tryStart(backend, model, scene, starts[0], report.isShort() ? 12 : 40);
        not_finite += outcome.finite ? 0 : 1;
        worst = std::max(worst, outcome.energy_ratio);
        table.add({nameOf(backend), row.name, nameOf(integrator), outcome.finite ? "yes" : "NO", outcome.energy_ratio,
                   outcome.energy_left, static_cast<double>(outcome.trips), outcome.ticks});
      }
    }
    report.checkAtMost(nameOf(backend) + ": ratios: values that are not finite", not_finite, 0);
    report.checkAtMost(nameOf(backend) + ": ratios: energy over start", worst, kEnergyBound);
  }
  report.add(table, "ratios");
}

double deepest(const TissueStepper& solver) {
  double out = 0;
  for (const layout::vec4& u : solver.readState().displacement_m) out = std::max(out, xyz(u).norm());
  return out;
}

void longRest(Report& report) {
  const Model model = blockModel(Vector3i::Constant(3), kSpacing_m, {}, [](const Vector3i& n) { return n.z() == 3; });
  Scene scene = sceneAt(model, Integrator::kLeapfrog, 0.75 / 0.82);
  scene.environment.gravity_m_per_s2 = Vector3d(0, 0, -9.81);
  const uint64_t total = report.isShort() ? 10000 : 1000000;
  Table table("hanging at rest", {{"backend"},
                                  {"substeps"},
                                  {"sag", "m", 7},
                                  {"change of sag", "1"},
                                  {"kinetic energy", "J"},
                                  {"stability monitor trips"}});
  for (Backend backend : report.backends()) {
    report.stage("a long rest, " + nameOf(backend));
    const std::unique_ptr<TissueStepper> solver = solverOn(backend, model, scene);
    const auto run = [&](uint64_t substeps) {
      while (solver->substepsDone() < substeps) solver->step({});
    };
    run(total / 5);  // settles: mass_damping_per_s acts for seconds
    const double before = deepest(*solver);
    run(total);
    const double after = deepest(*solver);
    table.add({nameOf(backend), static_cast<double>(solver->substepsDone()), after, after / before - 1,
               solver->health().kinetic_j, static_cast<double>(solver->health().trips)});
    if (report.isShort()) continue;  // not settled yet
    report.checkAtMost(nameOf(backend) + ": rest: change of sag", std::abs(after / before - 1), kRestChange);
  }
  report.add(table, "rest");
}

/// Writes a box as an OBJ file with edges of 20 mm in the file's units.
std::string boxFile(const std::string& folder, const std::string& name, double unit_m) {
  const std::string path = folder + "/" + name + ".obj";
  std::ofstream file(path);
  file.precision(12);
  for (int c = 0; c < 8; ++c) {
    for (int axis = 0; axis < 3; ++axis) file << (axis ? " " : "v ") << ((c >> axis) & 1) * 0.02 / unit_m;
    file << '\n';
  }
  const int faces[12][3] = {{1, 3, 2}, {2, 3, 4}, {5, 6, 7}, {6, 8, 7}, {1, 2, 5}, {2, 6, 5},
                            {3, 7, 4}, {4, 7, 8}, {1, 5, 3}, {3, 5, 7}, {2, 4, 6}, {4, 8, 6}};
  for (const auto& f : faces) file << "f " << f[0] << ' ' << f[1] << ' ' << f[2] << '\n';
  return path;
}

/// Returns the box of a file, fixed at its top.
Scene boxScene(const std::string& file, double unit_m) {
  Scene scene;
  BodyConfig body;
  body.source = TissueSource::kMesh;
  body.mesh_file = file;
  body.unit_scale_m = unit_m;
  body.spacing_m = kSpacing_m;
  body.fixed.push_back(clampAbove(0.019));
  scene.bodies.push_back(body);
  return scene;
}

struct Unit {
  const char* name;
  double m;
};
constexpr Unit kUnits[] = {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}};

void units(Report& report) {
  const std::string folder =
      (std::filesystem::temp_directory_path() / ("viscera_units_" + std::to_string(getpid()))).string();
  std::filesystem::create_directories(folder);
  Table table("the same box from files in three units, one second under gravity",
              {{"backend"}, {"unit"}, {"nodes"}, {"largest displacement", "m", 7}, {"apart from m", "1"}});
  for (Backend backend : report.backends()) {
    double in_m = 0, apart = 0;
    for (const Unit& unit : kUnits) {
      const Scene scene = boxScene(boxFile(folder, unit.name, unit.m), unit.m);
      const Model model = buildModel(scene);
      const std::unique_ptr<TissueStepper> solver = solverOn(backend, model, scene);
      for (int t = 0; t < (report.isShort() ? 10 : 60); ++t) solver->step({});
      const double sag = deepest(*solver);
      if (unit.m == 1) in_m = sag;
      apart = worse(apart, std::abs(sag / in_m - 1));
      table.add({nameOf(backend), unit.name, static_cast<double>(model.activeNodes()), sag, sag / in_m - 1});
    }
    report.checkAtMost(nameOf(backend) + ": units: displacement in cm and mm apart from that in m", apart, kUnitsApart);
    report.checkAtLeast(nameOf(backend) + ": units: largest displacement in m", in_m, kUnitsSag_m);
  }
  std::filesystem::remove_all(folder);
  report.add(table, "units");
}

/// A method of running the same substeps on one backend; all must end in the same bits.
struct Variant {
  std::string name;
  std::function<std::unique_ptr<TissueStepper>(const Model&, const Scene&)> make;
};

std::vector<Variant> variantsOf(Backend backend) {
  std::vector<Variant> out;
  if (backend == Backend::kGpu) {
    for (uint32_t group : {32u, 64u, 128u, 256u}) {
      out.push_back({"groups of " + std::to_string(group), [group](const Model& model, const Scene& scene) {
                       GpuSolverOptions options;
                       options.group_size = group;
                       return std::make_unique<GpuSolver>(model, scene, options);
                     }});
    }
    return out;
  }
  for (int threads : {1, 2, 3, 5}) {
    out.push_back({std::to_string(threads) + " threads", [threads](const Model& model, Scene scene) {
                     scene.solver.threads = threads;
                     return std::make_unique<CpuSolver>(model, scene);
                   }});
  }
  return out;
}

void hashes(Report& report, Law law, const std::string& stem) {
  MaterialConfig material;
  material.law = law;
  const Model model =
      blockModel(Vector3i::Constant(4), kSpacing_m, material, [](const Vector3i& n) { return n.z() == 4; });
  const uint64_t substeps = report.isShort() ? 2000 : 100000;
  Scene scene = sceneAt(model, Integrator::kLeapfrog, 0.5);
  scene.environment.gravity_m_per_s2 = Vector3d(3, 2, -9.81);
  Table table(stem + ": state hash after " + std::to_string(substeps) + " substeps",
              {{"backend"}, {"way"}, {"stability_monitor"}, {"run"}, {"hash"}});
  for (Backend backend : report.backends()) {
    report.stage(stem + ", " + nameOf(backend));
    std::vector<std::string> all;
    const std::vector<Variant> variants = variantsOf(backend);
    for (const Variant& variant : variants) {
      for (bool stability_monitor : {true, false}) {
        for (int again = 1; again <= (&variant == &variants[1] ? 2 : 1); ++again) {
          scene.solver.stability_monitor = stability_monitor;
          const std::unique_ptr<TissueStepper> solver = variant.make(model, scene);
          while (solver->substepsDone() < substeps) solver->step({});
          all.push_back(StateHash::text(stateHash(model, solver->readState())));
          table.add({nameOf(backend), variant.name, stability_monitor ? "on" : "off", again, all.back()});
        }
      }
    }
    const auto different = std::count_if(all.begin(), all.end(), [&](const std::string& h) { return h != all[0]; });
    report.checkAtMost(nameOf(backend) + ": " + stem + ": runs that differ from the first",
                       static_cast<double>(different), 0);
  }
  report.add(table, stem);
}

}  // namespace

void extremesOfStability(Report& report) {
  ratios(report);
  longRest(report);
  units(report);
  hashes(report, Law::kSprings, "hashes");
  hashes(report, Law::kNeoHookean, "hashes_law");
}

}  // namespace viscera::bench
