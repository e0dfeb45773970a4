// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Thin-walled organs and a block of two materials that hang under their weight, compared with an independent finite
// element program.
#include "bench/suites/walls/walls_suite.h"

#include <cmath>

#include "bench/harness/specimens/block.h"
#include "bench/suites/walls/walls_references.h"
#include "bench/suites/walls/walls_shapes.h"
#include "math/number_text.h"
#include "solver/cpu/equilibrium.h"
#include "solver/reference/statics.h"
#include "viscera/math/error.h"
#include "viscera/model/body/wall_cells.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

namespace {

/// Mean displacement along gravity, which is chosen accordingly [m]: strains are about 1e-4, so everything is linear,
/// and it is three thousandths of a spacing, so float32 resolves it.
constexpr double kWallsMean_m = 1e-5;
constexpr double kWallsRatios[] = {0.3, 0.45, 0.49};
constexpr double kWallsPercent = 100, kWallsMm = 1e3;

/// A spacing at which every organ is measured.
struct WallsSpacing {
  double spacing_m;
  bool is_short;         ///< whether it is measured in the short form too
  double most_nu = 0.5;  ///< largest nu: higher ones take minutes at fine spacings
};
constexpr WallsSpacing kWallsSpacings[] = {
    {0.00567, true}, {0.004, true}, {0.003, false}, {0.002, false}, {0.0015, false, 0.45}};
/// Number of cells across solid parts above which an organ is not measured at finer spacings.
constexpr double kThick = 10.5;
/// Largest number of nodes with a column in float64: one factorisation takes about ten seconds there.
constexpr size_t kMostInFloat64 = 9000;
/// Errors that are reached; organs that are not listed are shown only.
struct WallsLimit {
  const char* organ;
  double spacing_m;      ///< this spacing and finer ones
  double most;           ///< largest |error|
  double most_nu = 0.5;  ///< at these of kWallsRatios
};
constexpr WallsLimit kWallsLimits[] = {{"tube", 0.004, 0.065}, {"tube", 0.003, 0.05},    {"torus", 0.004, 0.07},
                                       {"torus", 0.002, 0.03}, {"block", 0.00567, 0.05}, {"block", 0.003, 0.03}};
/// Errors with `material.walls: rows`.
constexpr WallsLimit kRowsLimits[] = {
    {"tube", 0.004, 0.05},         {"tube", 0.003, 0.03},       {"ellipsoid", 0.003, 0.055},   {"torus", 0.003, 0.045},
    {"bowl", 0.00567, 0.05, 0.45}, {"bowl", 0.003, 0.03, 0.45}, {"stomach", 0.004, 0.03, 0.45}};

Scene hangingScene(const Organ& organ, const OrganFile& file, double nu, double spacing_m) {
  BodyConfig body;
  body.name = organ.name;
  body.source = TissueSource::kMesh;
  body.mesh_file = file.path();
  body.textures = false;
  body.spacing_m = spacing_m;
  body.material.young_modulus_pa = kWallsYoung_pa;
  body.material.poisson_ratio = nu;
  body.material.density_kg_per_m3 = kWallsDensity_kg_per_m3;
  body.material.law = Law::kNeoHookean;
  body.fixed = {organ.clamp};
  if (!organ.position) {
    PartConfig part{"soft"};
    part.poisson_ratio = nu;
    part.density_kg_per_m3 = kWallsDensity_kg_per_m3;
    part.young_modulus_pa = kWallsSoft_pa;
    body.parts.push_back(part);
    part.part = "stiff";
    part.young_modulus_pa = kWallsYoung_pa;
    body.parts.push_back(part);
  }
  Scene scene;
  scene.bodies = {body};
  const double load = kWallsGravity * kWallsMean_m / wallsReference(organ.name, nu).mean_m;
  scene.environment.gravity_m_per_s2 = load * organ.load;
  return scene;
}

/// One organ hanging in equilibrium. Errors are those of the mean displacement along gravity, relative; not finite: no
/// equilibrium was found or requested.
struct HangingOrgan {
  size_t nodes = 0, in_walls = 0;  ///< cells in thin walls, where second derivatives are from rows of nodes
  SettleReport settle, settle_rows;
  double settled = std::nan(""), settled_rows = std::nan(""), float64 = std::nan("");
};

/// Returns the error of the displacement along gravity, weighted by mass, relative to the reference.
/// @param at  displacement of a slot [m]
template <class At>
double errorOf(const ReferenceSolver& solver, const Vector3d& along, const At& at) {
  double moved = 0, mass_kg = 0;
  for (const uint32_t slot : solver.active) {
    moved += solver.mass(slot) * at(slot).dot(along);
    mass_kg += solver.mass(slot);
  }
  return moved / mass_kg / kWallsMean_m - 1;
}

/// Returns the error of the equilibrium that the CPU backend finds.
double settledError(const Model& model, const Scene& scene, const ReferenceSolver& solver, const Vector3d& along,
                    SettleReport& report) {
  try {
    const HostState state = equilibriumOf(model, scene, report);
    return errorOf(solver, along, [&](uint32_t slot) { return xyz(state.displacement_m[slot]); });
  } catch (const Error&) {  // shown in the table
    return std::nan("");
  }
}

HangingOrgan hang(const Organ& organ, const OrganFile& file, double nu, double spacing_m) {
  const Scene scene = hangingScene(organ, file, nu, spacing_m);
  Model model = buildModel(scene);
  const ReferenceSolver solver(model, Vector3d::Zero(), 1);
  HangingOrgan out;
  out.nodes = model.activeNodes();
  out.settled = settledError(model, scene, solver, organ.load, out.settle);
  for (Body& body : model.bodies) {
    body.material.walls = Walls::kRows;
    addRowGhosts(body);
    out.in_walls += wallCells(body).size();
  }
  if (out.in_walls > 0) out.settled_rows = settledError(model, scene, solver, organ.load, out.settle_rows);
  if (out.nodes > kMostInFloat64) return out;
  try {
    Field weight(solver.slots(), Vector3d::Zero());
    for (const uint32_t slot : solver.active) weight[slot] = solver.mass(slot) * scene.environment.gravity_m_per_s2;
    const Field u = solveLinear(solver, {}, weight);
    out.float64 = errorOf(solver, organ.load, [&](uint32_t slot) { return u[slot]; });
  } catch (const ConvergenceError&) {
  }
  return out;
}

/// Returns an error in %, or the text if there is none.
Cell errorCell(double error, const char* otherwise) {
  return std::isfinite(error) ? Cell(kWallsPercent * error) : Cell(otherwise);
}

/// Checks an organ. @param limits  kWallsLimits or kRowsLimits   @param how  description of these
template <size_t kLimits>
void checkOrgan(Report& report, const WallsLimit (&limits)[kLimits], const char* how, const Organ& organ, double nu,
                double spacing_m, double error) {
  for (const WallsLimit& limit : limits) {
    if (organ.name != std::string(limit.organ) || spacing_m > limit.spacing_m || nu > limit.most_nu) continue;
    report.checkAtMost(std::string(organ.name) + how + ", nu " + numberText(nu, 2) + ", " +
                           numberText(kWallsMm * spacing_m, 3) + " mm: displacement over CalculiX's, minus 1",
                       std::abs(error), limit.most);
  }
}

void measureOrgan(Report& report, const Organ& organ) {
  Table table(organ.what, {{"nu"},
                           {"spacing", "mm"},
                           {"cells a wall", "", 3},
                           {"nodes", "", 6},
                           {"CalculiX", "mm/g"},
                           {"settled", "%", 3},
                           {"float64", "%", 3},
                           {"took", "s", 2},
                           {"substeps", "", 6},
                           {"in walls", "", 6},
                           {"by rows", "%", 3},
                           {"took", "s", 2},
                           {"substeps", "", 6}});
  const OrganFile file(organ);
  for (const double nu : kWallsRatios) {
    const WallsReference& truth = wallsReference(organ.name, nu);
    for (const WallsSpacing& spacing : kWallsSpacings) {
      if (report.isShort() && !spacing.is_short) continue;
      if (nu > spacing.most_nu || organ.wall_m > kThick * spacing.spacing_m) continue;
      report.stage(std::string(organ.name) + ", nu " + numberText(nu, 2) + ", " +
                   numberText(kWallsMm * spacing.spacing_m, 3) + " mm");
      const HangingOrgan found = hang(organ, file, nu, spacing.spacing_m);
      table.add({nu, kWallsMm * spacing.spacing_m, organ.wall_m / spacing.spacing_m, static_cast<double>(found.nodes),
                 kWallsMm * truth.mean_m, errorCell(found.settled, "no equilibrium"), errorCell(found.float64, ""),
                 found.settle.seconds, found.settle.substeps, static_cast<double>(found.in_walls),
                 errorCell(found.settled_rows, found.in_walls > 0 ? "no equilibrium" : ""), found.settle_rows.seconds,
                 found.settle_rows.substeps});
      checkOrgan(report, kWallsLimits, "", organ, nu, spacing.spacing_m, found.settled);
      checkOrgan(report, kRowsLimits, " by rows", organ, nu, spacing.spacing_m, found.settled_rows);
    }
  }
  report.add(table, organ.name);
}

/// Prints the reference values.
void showReferences(Report& report) {
  Table table(
      "CalculiX 2.20, small strain: mean displacement under the organ's weight; the finest meshes, short of it by",
      {{"organ"}, {"nu"}, {"mean", "mm"}, {"nodes of half", "", 6}, {"C3D20", "%", 1}, {"C3D20R", "%", 1}});
  for (const WallsReference& row : wallsReferences())
    table.add(
        {row.organ, row.nu, kWallsMm * row.mean_m, row.nodes, kWallsPercent * row.full, kWallsPercent * row.reduced});
  report.add(table, "references");
}

template <size_t kOrgan>
void measure(Report& report) {
  measureOrgan(report, organs().at(kOrgan));
}

template <size_t... kOrgan>
std::vector<Part> partsOf(std::index_sequence<kOrgan...> /*organs*/) {
  return {{"references", showReferences}, {organs().at(kOrgan).name, measure<kOrgan>}...};
}

}  // namespace

void wallsSuite(Report& report) {
  measureParts(report, partsOf(std::make_index_sequence<kOrgans>()));
}

}  // namespace viscera::bench
